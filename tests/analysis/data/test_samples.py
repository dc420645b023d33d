"""Samples that an objective compares."""

from __future__ import annotations

from typing import Any

import attrs
import numpy as np

from evoframe import Design, Outcome, Record
from evoframe.analysis.data.samples import samples_of

POSITIONS = np.arange(6.0).reshape(2, 3)


@attrs.frozen
class Selecting:
    """An objective with a given record."""

    record: Record


@attrs.frozen(eq=False)
class Returning:
    """A simulator that returns given positions."""

    positions: Any

    def simulate(self, designs: list[Design], record: Record) -> list[Outcome]:
        assert (len(designs), record.tracks) == (1, ("tip",))
        n = len(self.positions)
        return [Outcome(np.arange(n), np.linspace(0.0, 0.01 * (n - 1), n), {"tip": self.positions})]


def names_and_times(record: Record, positions: Any = POSITIONS) -> list[tuple[str, float]]:
    simulator: Any = Returning(positions)
    objective: Any = Selecting(record)
    return [(each.name, each.time) for each in samples_of(simulator, objective, Design({}), "tip")]


def test_selected_samples_have_names_times_and_positions() -> None:
    record = Record(("tip",), samples=(0, 5))
    assert names_and_times(record) == [("sample 0", 0.0), ("sample 5", 0.01)]
    simulator: Any = Returning(POSITIONS)
    objective: Any = Selecting(record)
    found = samples_of(simulator, objective, Design({}), "tip")
    assert [each.position for each in found] == [(0.0, 1.0, 2.0), (3.0, 4.0, 5.0)]


def test_the_initial_state_is_a_sample_too() -> None:
    assert names_and_times(Record(("tip",), samples=(5,), initial=True)) == [
        ("start", 0.0),
        ("sample 5", 0.01),
    ]


def test_a_record_of_all_samples_selects_none() -> None:
    assert names_and_times(Record(("tip",))) == []


def test_samples_after_a_divergence_are_omitted() -> None:
    diverged = np.array([[0.0, 0.0, 0.0], [np.nan] * 3])
    record = Record(("tip",), samples=(0, 5))
    assert names_and_times(record, diverged) == [("sample 0", 0.0)]
    assert names_and_times(record, diverged[:0]) == []
