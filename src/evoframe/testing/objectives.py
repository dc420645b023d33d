"""The laws of objectives."""

from __future__ import annotations

import math

import numpy as np
from hypothesis import strategies as st

from evoframe.contract import Objective, Outcome, Record, window_of
from evoframe.testing.components import ComponentContract
from evoframe.testing.laws import for_all, same_outcome

__all__ = ["ObjectiveContract"]


class ObjectiveContract(ComponentContract[Objective]):
    """The laws of an :class:`~evoframe.Objective`.

    If the objective requires more of an outcome than its record declares, override :meth:`outcomes`.
    """

    protocol = Objective

    def outcomes(self) -> st.SearchStrategy[Outcome]:
        """Return outcomes like those of a simulator for the objective's record."""
        record = self.component.record
        least = 1 + math.ceil(record.until / _interval(record))
        rows = st.integers(least, least + 20) if record.samples is None else st.just(len(record.samples))
        extents = st.sampled_from([0.0, 1e-3, 1.0, 1e6])
        return st.builds(_outcome, st.just(record), rows, st.integers(0, 2**32 - 1), extents)

    def test_its_record_has_tracks(self) -> None:
        """The record names at least one track."""
        record = self.component.record
        assert isinstance(record, Record), f"expected a Record, found {type(record).__name__}"
        assert record.tracks, "expected a record of at least one track, found none"

    def test_the_score_is_finite(self) -> None:
        """The score of every outcome that did not diverge is a finite float."""

        def law(outcome: Outcome) -> None:
            score = self.component.score(outcome)
            assert isinstance(score, float), (
                f"score() must return a float, found {type(score).__name__}; convert it with float()"
            )
            assert math.isfinite(score), f"score() must be finite for finite tracks, found {score}"

        for_all(law, outcome=self.outcomes())

    def test_the_same_outcome_has_the_same_score(self) -> None:
        """Equal outcomes have equal scores, to the last bit."""

        def law(outcome: Outcome) -> None:
            first, second = self.component.score(outcome), self.component.score(outcome)
            assert first.hex() == second.hex(), f"the same outcome scores {first}, then {second}"

        for_all(law, outcome=self.outcomes())

    def test_the_window_consists_of_two_samples(self) -> None:
        """The first and last time on which the score depends are times of samples, in order."""

        def law(outcome: Outcome) -> None:
            window = window_of(self.component, outcome.times)
            assert window is not None, "expected two times, found none"
            first, last = window
            assert {first, last} <= set(outcome.times.tolist()), f"expected times of samples, found {window}"
            assert first <= last, f"expected the first time before the last, found {window}"

        for_all(law, outcome=self.outcomes())

    def test_samples_outside_the_window_do_not_matter(self) -> None:
        """The score stays the same, to the last bit, if positions outside of the window change."""

        def law(outcome: Outcome) -> None:
            window = window_of(self.component, outcome.times)
            assert window is not None, "expected two times, found none"
            outside = (outcome.times < window[0]) | (outcome.times > window[1])
            moved = {name: track + outside[:, None] for name, track in outcome.tracks.items()}
            changed = Outcome(outcome.steps, outcome.times, moved)
            first, second = self.component.score(outcome), self.component.score(changed)
            assert first.hex() == second.hex(), f"the score depends on samples outside of {window} s"

        for_all(law, outcome=self.outcomes())

    def test_the_outcome_is_not_changed(self) -> None:
        """``score`` does not change the outcome, which others read too."""

        def law(outcome: Outcome) -> None:
            copy = Outcome(
                outcome.steps.copy(),
                outcome.times.copy(),
                {name: track.copy() for name, track in outcome.tracks.items()},
            )
            self.component.score(outcome)
            assert same_outcome(outcome, copy), "score() changes the arrays of the outcome; work on copies"

        for_all(law, outcome=self.outcomes())


def _interval(record: Record) -> float:
    return record.every or 0.001


def _outcome(record: Record, rows: int, seed: int, extent: float) -> Outcome:
    """Return an outcome with random positions from -*extent* to *extent* for each track."""
    samples = np.arange(rows) if record.samples is None else np.array(record.samples)
    steps = np.concatenate([[0], samples + 1]) if record.initial else samples + 1
    rng = np.random.default_rng(seed)
    return Outcome(
        steps=steps.astype(np.int64),
        times=np.multiply(steps, _interval(record), dtype=np.float64),
        tracks={name: rng.uniform(-extent, extent, size=(len(steps), 3)) for name in record.tracks},
    )
