"""The loop of coevolution: what it did, and how it is stopped and continued."""

from __future__ import annotations

import json
from collections.abc import Iterable
from typing import Any

from evoframe import Coevolution, RunConfig, Turn, assemble


def history(turns: Iterable[Turn]) -> list[Any]:
    """Return all but the measured time."""
    return [(turn.index, turn.reports, turn.pairs) for turn in turns]


def stopped(config: RunConfig, at: int) -> Coevolution:
    """Return a loop that was left after the turn with the index *at*."""
    coevolution = assemble(config)
    for turn in coevolution:
        if turn.index == at:
            break
    return coevolution


def continued(config: RunConfig, left: Coevolution) -> Coevolution:
    """Return another loop with the state of *left*, which has passed through JSON."""
    coevolution = assemble(config)
    coevolution.restore(json.loads(json.dumps(left.state())))
    return coevolution
