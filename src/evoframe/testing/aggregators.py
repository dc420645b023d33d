"""The laws of aggregators."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np
from hypothesis import strategies as st

from evoframe.contract import Aggregator, Scores
from evoframe.contract.optional import SupportsExemptions
from evoframe.testing.components import ComponentContract
from evoframe.testing.laws import accepted, at_most, for_all, refusal, same_bits

__all__ = ["AggregatorContract"]

LARGEST = 1e100
EXEMPTIBLE = ("bounded", "idempotent", "monotone")


class AggregatorContract(ComponentContract[Aggregator]):
    """The laws of an :class:`~evoframe.Aggregator`.

    Attributes:
        counts: Numbers of collaborators to try; those that ``check`` refuses are not aggregated.
    """

    protocol = Aggregator
    counts: ClassVar[range] = range(-1, 31)

    def test_numbers_of_collaborators_are_refused_by_a_configuration_error(self) -> None:
        """``check`` raises nothing else, says why, refuses 0 and less, and accepts something."""
        assert "" not in [refusal(self.component.check, n) for n in self.counts], "a refusal says nothing"
        counts = accepted(self.component.check, self.counts)
        assert counts, f"check() refuses every n in {self.counts}"
        assert min(counts) >= 1, f"check() accepts {min(counts)} collaborators"

    def test_the_result_is_finite(self) -> None:
        """Finite scores up to 1e100, however small, give a finite float."""

        def law(scores: list[float]) -> None:
            result = self.component.aggregate(_array(scores))
            assert isinstance(result, float), f"the result is a {type(result).__name__}, not a float"
            assert math.isfinite(result)

        for_all(law, scores=self.scores(-LARGEST, LARGEST))

    def test_the_order_of_the_scores_is_irrelevant(self) -> None:
        """To the last bit."""

        def law(scores: list[float], random: Any) -> None:
            shuffled = random.sample(scores, len(scores))
            assert self._bits(scores) == self._bits(shuffled)

        for_all(law, scores=self.scores(-LARGEST, LARGEST), random=st.randoms(use_true_random=False))

    def test_the_scores_are_left_alone(self) -> None:
        """An array that is handed over is not changed."""

        def law(scores: list[float]) -> None:
            given = _array(scores)
            self.component.aggregate(given)
            assert same_bits(given, _array(scores))

        for_all(law, scores=self.scores(-LARGEST, LARGEST))

    def test_the_domain_is_a_range(self) -> None:
        """Two numbers, the smaller one first."""
        low, high = self.component.domain
        assert low <= high

    def test_exemptions_name_a_law_and_a_reason(self) -> None:
        """Whoever breaks a law says which, and why."""
        for law, reason in self._exemptions().items():
            assert law in EXEMPTIBLE, f"there is no law '{law}' to be exempt from; laws: {EXEMPTIBLE}"
            assert reason.strip(), f"say why the component is exempt from '{law}'"

    def test_the_result_lies_within_the_scores(self) -> None:
        """The law ``bounded``: min <= result <= max."""

        def law(scores: list[float]) -> None:
            result = self.component.aggregate(_array(scores))
            assert at_most(min(scores), result)
            assert at_most(result, max(scores))

        self._unless_exempt("bounded", law, scores=self.scores(*self._domain()))

    def test_equal_scores_give_that_score(self) -> None:
        """The law ``idempotent``."""

        def law(score: float, n: int) -> None:
            result = self.component.aggregate(_array([score] * n))
            assert at_most(score, result)
            assert at_most(result, score)

        self._unless_exempt("idempotent", law, score=_floats(*self._domain()), n=self.sizes())

    def test_the_result_is_no_less_when_a_score_grows(self) -> None:
        """The law ``monotone``."""
        _, high = self._domain()

        def law(scores: list[float], data: st.DataObject) -> None:
            index = data.draw(st.integers(0, len(scores) - 1), label="index of the score that grows")
            grown = [*scores]
            grown[index] = data.draw(_floats(scores[index], high), label="what it grows to")
            before = self.component.aggregate(_array(scores))
            after = self.component.aggregate(_array(grown))
            assert at_most(before, after)

        self._unless_exempt("monotone", law, scores=self.scores(*self._domain()), data=st.data())

    def sizes(self) -> st.SearchStrategy[int]:
        """Return the numbers of scores that the component accepts."""
        return st.sampled_from(accepted(self.component.check, self.counts))

    def scores(self, low: float, high: float) -> st.SearchStrategy[list[float]]:
        """Return lists of scores from *low* to *high* in the accepted numbers."""
        return self.sizes().flatmap(lambda n: _lists(low, high, n))

    def _domain(self) -> tuple[float, float]:
        low, high = self.component.domain
        return max(low, -LARGEST), min(high, LARGEST)

    def _bits(self, scores: list[float]) -> str:
        return self.component.aggregate(_array(scores)).hex()

    def _exemptions(self) -> Mapping[str, str]:
        component = self.component
        return component.exempt_from if isinstance(component, SupportsExemptions) else {}

    def _unless_exempt(self, name: str, law: Any, **strategies: st.SearchStrategy[Any]) -> None:
        reason = self._exemptions().get(name)
        if reason is None:
            for_all(law, **strategies)
        else:
            assert reason.strip(), f"say why the component is exempt from '{name}'"


def _array(scores: list[float]) -> Scores:
    return np.array(scores, dtype=np.float64)


def _floats(low: float, high: float) -> st.SearchStrategy[float]:
    """Return numbers of all magnitudes, and often the ends, the smallest ones and some like displacements."""
    special = (low, -0.01, -5e-324, 0.0, 5e-324, 1e-6, 0.004, 0.005, 1.0, high)
    return st.floats(low, high) | st.sampled_from([value for value in special if low <= value <= high])


def _lists(low: float, high: float, n: int) -> st.SearchStrategy[list[float]]:
    """Return lists of *n* scores; half of them have two values only, so that scores meet their equals."""
    score = _floats(low, high)
    two_values = st.tuples(score, score).map(st.sampled_from)
    return st.lists(score, min_size=n, max_size=n) | two_values.flatmap(
        lambda value: st.lists(value, min_size=n, max_size=n)
    )
