"""Robustness measurements with toy components."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import toys

from evoframe import Body, Design, Robustness, Setting
from evoframe.contract.protocols import ExecutorRun
from evoframe.robustness.measurement import Bench, digest_of

__all__ = ["body", "measure", "setting"]


def body(a: float) -> Design:
    """Return a toy body whose score is *a* times its controller."""
    return Design({"a": np.array([a]), "b": np.zeros(1)})


def setting(
    designs: Sequence[Design], controllers: int, seed: int = 1, groups: Sequence[str] = (), unit: str = ""
) -> Setting:
    """Return the setting of a measurement of bodies A, B, ...; each is a group unless *groups* are given."""
    labels = [chr(ord("A") + number) for number in range(len(designs))]
    bodies = [
        Body(label, group, digest_of(toys.Steered(), design), f"{label}.toy")
        for label, group, design in zip(labels, groups or labels, designs, strict=True)
    ]
    return Setting(seed, controllers, unit, {"simulator": {"name": "toy-steered"}}, tuple(bodies))


def measure(
    numbers: Sequence[float],
    controllers: int = 20,
    *,
    most: float = 1e9,
    seed: int = 1,
    groups: Sequence[str] = (),
    unit: str = "",
    workers: ExecutorRun | None = None,
) -> Robustness:
    """Measure the toy bodies with these numbers; a score above *most* is a divergence."""
    designs = [body(number) for number in numbers]
    bench = Bench(toys.Steered(most=most), toys.Value(), workers or toys.Here())
    return bench.measure(setting(designs, controllers, seed, groups, unit), designs)
