"""Loops of coevolution: their histories, and loops that are stopped and continued."""

from __future__ import annotations

import json
from collections.abc import Iterable
from typing import Any

from evoframe import Coevolution, RunConfig, Turn, assemble


def history(turns: Iterable[Turn]) -> list[Any]:
    """Return the results of turns, without measured times."""
    return [(turn.index, turn.reports, turn.pairs) for turn in turns]


def stopped(config: RunConfig, at: int) -> Coevolution:
    """Return a loop that was stopped after the turn with the index *at*."""
    coevolution = assemble(config)
    for turn in coevolution:
        if turn.index == at:
            break
    return coevolution


def continued(config: RunConfig, left: Coevolution) -> Coevolution:
    """Return a new loop with the state of *left*, converted to JSON and back."""
    coevolution = assemble(config)
    coevolution.restore(json.loads(json.dumps(left.state())))
    return coevolution
