"""The laws of objectives."""

from __future__ import annotations

import math

import numpy as np
from hypothesis import strategies as st

from evoframe.contract import Objective, Outcome, Record
from evoframe.testing.components import ComponentContract
from evoframe.testing.laws import for_all, same_outcome

__all__ = ["ObjectiveContract"]


class ObjectiveContract(ComponentContract[Objective]):
    """The laws of an :class:`~evoframe.Objective`.

    An objective that needs more of an outcome than its record says overrides :meth:`outcomes`.
    """

    protocol = Objective

    def outcomes(self) -> st.SearchStrategy[Outcome]:
        """Return outcomes as a simulator delivers them for the objective's record."""
        record = self.component.record
        least = 1 + math.ceil(record.until / _interval(record))
        rows = st.integers(least, least + 20) if record.samples is None else st.just(len(record.samples))
        extents = st.sampled_from([0.0, 1e-3, 1.0, 1e6])
        return st.builds(_outcome, st.just(record), rows, st.integers(0, 2**32 - 1), extents)

    def test_it_says_what_must_be_recorded(self) -> None:
        """At least one track."""
        assert isinstance(self.component.record, Record)
        assert self.component.record.tracks

    def test_the_score_is_finite(self) -> None:
        """For every outcome that did not diverge."""

        def law(outcome: Outcome) -> None:
            score = self.component.score(outcome)
            assert isinstance(score, float), f"the score is a {type(score).__name__}, not a float"
            assert math.isfinite(score)

        for_all(law, outcome=self.outcomes())

    def test_the_same_outcome_has_the_same_score(self) -> None:
        """To the last bit."""

        def law(outcome: Outcome) -> None:
            assert self.component.score(outcome).hex() == self.component.score(outcome).hex()

        for_all(law, outcome=self.outcomes())

    def test_the_outcome_is_left_alone(self) -> None:
        """Others read it too."""

        def law(outcome: Outcome) -> None:
            copy = Outcome(
                outcome.steps.copy(),
                outcome.times.copy(),
                {name: track.copy() for name, track in outcome.tracks.items()},
            )
            self.component.score(outcome)
            assert same_outcome(outcome, copy)

        for_all(law, outcome=self.outcomes())


def _interval(record: Record) -> float:
    return record.every or 0.001


def _outcome(record: Record, rows: int, seed: int, extent: float) -> Outcome:
    """Return random positions of the size of *extent* for each track."""
    samples = np.arange(rows) if record.samples is None else np.array(record.samples)
    steps = np.concatenate([[0], samples + 1]) if record.initial else samples + 1
    rng = np.random.default_rng(seed)
    return Outcome(
        steps=steps.astype(np.int64),
        times=np.multiply(steps, _interval(record), dtype=np.float64),
        tracks={name: rng.uniform(-extent, extent, size=(len(steps), 3)) for name in record.tracks},
    )
