"""Batches of designs that a run gives to its simulator."""

from __future__ import annotations

import contextlib
import itertools
from collections.abc import Iterator, Sequence
from typing import Any, TypeAlias
from unittest import mock

from evoframe import Design, RunConfig

__all__ = ["Batch", "recording"]

Batch: TypeAlias = Sequence[Design]


@contextlib.contextmanager
def recording(config: RunConfig, batches: list[Batch], every: int = 1) -> Iterator[None]:
    """Append every nth batch that is simulated within a ``with`` block to *batches*."""
    simulator = type(config.simulator.component)
    simulate: Any = simulator.simulate
    number = itertools.count()

    def recorded(component: Any, designs: Batch, record: Any) -> Any:
        if next(number) % every == 0:
            batches.append(designs)
        return simulate(component, designs, record)

    with mock.patch.object(simulator, "simulate", recorded):
        yield
