"""The value of a simulation that is the evaluation of a function: the objective ``value``."""

from __future__ import annotations

from typing import ClassVar

import attrs

from evoframe import Outcome, Record

__all__ = ["Value"]


@attrs.frozen
class Value:
    """Value of the track ``value``, which the simulator ``functions`` records; it has no unit."""

    record: ClassVar[Record] = Record(tracks=("value",), samples=(0,))

    def score(self, outcome: Outcome) -> float:
        """Return the value of the only sample."""
        return float(outcome.tracks["value"][0, 0])
