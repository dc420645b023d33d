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
        counts: Numbers of collaborators to test; those that ``check`` refuses are not aggregated.
    """

    protocol = Aggregator
    counts: ClassVar[range] = range(-1, 31)

    def test_numbers_of_collaborators_are_refused_by_a_configuration_error(self) -> None:
        """``check`` raises only ``ConfigurationError`` with a message; it refuses n < 1, but not all n."""
        for n in self.counts:
            assert refusal(self.component.check, n) != "", f"check({n}) raises an error without a message"
        counts = accepted(self.component.check, self.counts)
        assert counts, f"check() refuses every n in {self.counts}; accept at least one, or override 'counts'"
        assert min(counts) >= 1, f"check() must refuse n < 1, but accepts {min(counts)}"

    def test_the_result_is_finite(self) -> None:
        """Finite scores of any magnitude up to 1e100 give a finite float."""

        def law(scores: list[float]) -> None:
            result = self.component.aggregate(_array(scores))
            assert isinstance(result, float), (
                f"aggregate() must return a float, found {type(result).__name__}; convert it with float()"
            )
            assert math.isfinite(result), f"aggregate() must be finite for finite scores, found {result}"

        for_all(law, scores=self.scores(-LARGEST, LARGEST))

    def test_the_order_of_the_scores_is_irrelevant(self) -> None:
        """The result does not depend on the order of the scores, to the last bit."""

        def law(scores: list[float], random: Any) -> None:
            shuffled = random.sample(scores, len(scores))
            assert self._bits(scores) == self._bits(shuffled), (
                "aggregate() depends on the order of the scores; sort them first, or sum with math.fsum()"
            )

        for_all(law, scores=self.scores(-LARGEST, LARGEST), random=st.randoms(use_true_random=False))

    def test_the_scores_are_not_changed(self) -> None:
        """``aggregate`` does not change its argument."""

        def law(scores: list[float]) -> None:
            given = _array(scores)
            self.component.aggregate(given)
            assert same_bits(given, _array(scores)), "aggregate() changes its argument; work on a copy"

        for_all(law, scores=self.scores(-LARGEST, LARGEST))

    def test_the_domain_is_a_range(self) -> None:
        """The domain is two numbers, the smaller one first."""
        low, high = self.component.domain
        assert low <= high, f"expected a domain (low, high) with low <= high, found ({low}, {high})"

    def test_exemptions_name_a_law_and_a_reason(self) -> None:
        """A component that breaks a law declares the law and the reason."""
        for law, reason in self._exemptions().items():
            assert law in EXEMPTIBLE, f"exempt_from: unknown law '{law}'; known: {', '.join(EXEMPTIBLE)}"
            assert reason.strip(), f"exempt_from: the exemption from '{law}' requires a reason"

    def test_the_result_lies_within_the_scores(self) -> None:
        """The law ``bounded``: min <= result <= max."""

        def law(scores: list[float]) -> None:
            result = self.component.aggregate(_array(scores))
            assert at_most(min(scores), result), f"bounded: expected at least {min(scores)}, found {result}"
            assert at_most(result, max(scores)), f"bounded: expected at most {max(scores)}, found {result}"

        self._unless_exempt("bounded", law, scores=self.scores(*self._domain()))

    def test_equal_scores_give_that_score(self) -> None:
        """The law ``idempotent``: the result of equal scores is that score."""

        def law(score: float, n: int) -> None:
            result = self.component.aggregate(_array([score] * n))
            assert at_most(score, result), (
                f"idempotent: expected {score} for {n} equal scores, found {result}"
            )
            assert at_most(result, score), (
                f"idempotent: expected {score} for {n} equal scores, found {result}"
            )

        self._unless_exempt("idempotent", law, score=_floats(*self._domain()), n=self.sizes())

    def test_the_result_does_not_fall_when_a_score_rises(self) -> None:
        """The law ``monotone``: raising a score does not lower the result."""
        _, high = self._domain()

        def law(scores: list[float], data: st.DataObject) -> None:
            index = data.draw(st.integers(0, len(scores) - 1), label="index of the raised score")
            raised = [*scores]
            raised[index] = data.draw(_floats(scores[index], high), label="raised score")
            before = self.component.aggregate(_array(scores))
            after = self.component.aggregate(_array(raised))
            assert at_most(before, after), (
                f"monotone: raising score {index} from {scores[index]} to {raised[index]} lowers the result "
                f"from {before} to {after}"
            )

        self._unless_exempt("monotone", law, scores=self.scores(*self._domain()), data=st.data())

    def sizes(self) -> st.SearchStrategy[int]:
        """Return the numbers of scores that the component accepts."""
        return st.sampled_from(accepted(self.component.check, self.counts))

    def scores(self, low: float, high: float) -> st.SearchStrategy[list[float]]:
        """Return lists of scores between *low* and *high*, of all accepted lengths."""
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
            assert reason.strip(), f"exempt_from: the exemption from '{name}' requires a reason"


def _array(scores: list[float]) -> Scores:
    return np.array(scores, dtype=np.float64)


def _floats(low: float, high: float) -> st.SearchStrategy[float]:
    """Return numbers of all magnitudes, often the bounds, the smallest floats or typical displacements."""
    special = (low, -0.01, -5e-324, 0.0, 5e-324, 1e-6, 0.004, 0.005, 1.0, high)
    return st.floats(low, high) | st.sampled_from([value for value in special if low <= value <= high])


def _lists(low: float, high: float, n: int) -> st.SearchStrategy[list[float]]:
    """Return lists of *n* scores; half of the lists contain only two values, so that there are ties."""
    score = _floats(low, high)
    two_values = st.tuples(score, score).map(st.sampled_from)
    return st.lists(score, min_size=n, max_size=n) | two_values.flatmap(
        lambda value: st.lists(value, min_size=n, max_size=n)
    )
