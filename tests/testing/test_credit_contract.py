import math
from collections.abc import Callable
from typing import Any

import attrs
import numpy as np
import pytest
from contracts import name_of
from numpy.typing import NDArray

from evoframe import ConfigurationError, ScoredMeetings
from evoframe.testing import CreditContract

COUNTS = "test_numbers_of_collaborators_are_refused_by_a_configuration_error"
VALUES = "test_each_member_has_one_finite_value"
ORDER = "test_the_order_of_the_meetings_is_irrelevant"
DIVERGED = "test_a_diverged_meeting_spoils_no_other_member"
NOT_CHANGED = "test_the_meetings_are_not_changed"
SAME = "test_the_same_meetings_give_the_same_values"


def mean_of(scores: NDArray[np.float64]) -> float:
    known = scores[~np.isnan(scores)].tolist()
    return math.fsum(known) / len(known) if known else math.nan


@attrs.frozen
class Mean:
    """A valid credit, and the base of the broken ones."""

    def check(self, n: int) -> None:
        if n < 1:
            raise ConfigurationError(f"at least 1 collaborator, not {n}")

    def credit(self, meetings: ScoredMeetings, population: int) -> Any:
        return np.array([self.value(meetings.scores[own]) for own in meetings.of(population)])

    def value(self, scores: NDArray[np.float64]) -> float:
        return mean_of(scores)


class AboveTheMean(Mean):
    """Depends on the scores of all others."""

    def credit(self, meetings: ScoredMeetings, population: int) -> Any:
        return super().credit(meetings, population) - mean_of(meetings.scores)


class OnlyThree(Mean):
    def check(self, n: int) -> None:
        if n != 3:
            raise ConfigurationError(f"3 collaborators, not {n}")


class TestMean(CreditContract):
    component = Mean()


class TestAboveTheMean(CreditContract):
    component = AboveTheMean()


class TestOnlyThree(CreditContract):
    component = OnlyThree()


class First(Mean):
    def value(self, scores: NDArray[np.float64]) -> float:
        return float(scores[0])


class UnsortedMean(Mean):
    """Depends on the order of the meetings in its last bit only."""

    def value(self, scores: NDArray[np.float64]) -> float:
        total = 0.0
        for score in scores.tolist():  # not sum(), which compensates rounding from Python 3.12 on
            total += score / len(scores)
        return total


class Product(Mean):
    def value(self, scores: NDArray[np.float64]) -> float:
        return float(math.prod(np.sort(scores).tolist()))


class AsList(Mean):
    def credit(self, meetings: ScoredMeetings, population: int) -> Any:
        return super().credit(meetings, population).tolist()


class Single(Mean):
    def credit(self, meetings: ScoredMeetings, population: int) -> Any:
        return np.zeros(meetings.present[population], np.float32)


class OneForEachMeeting(Mean):
    def credit(self, meetings: ScoredMeetings, population: int) -> Any:
        return np.zeros(len(meetings.scores))


class OfTheFirstPopulation(Mean):
    def credit(self, meetings: ScoredMeetings, population: int) -> Any:
        return super().credit(meetings, 0)


class SpoiltByDivergence(Mean):
    def credit(self, meetings: ScoredMeetings, population: int) -> Any:
        return super().credit(meetings, population) - math.fsum(meetings.scores.tolist())


class ChangesScores(Mean):
    def credit(self, meetings: ScoredMeetings, population: int) -> Any:
        meetings.scores[np.isnan(meetings.scores)] = 0.0
        return super().credit(meetings, population)


class ChangesMeetings(Mean):
    def credit(self, meetings: ScoredMeetings, population: int) -> Any:
        meetings.meetings[:, population] = 0
        return np.zeros(meetings.present[population])


class Random(Mean):
    def credit(self, meetings: ScoredMeetings, population: int) -> Any:
        return np.random.default_rng().normal(size=meetings.present[population])


class SeedsGlobally(Mean):
    def credit(self, meetings: ScoredMeetings, population: int) -> Any:
        np.random.seed(meetings.turn)  # noqa: NPY002 - the fault under test
        return super().credit(meetings, population)


class AcceptsNothing(Mean):
    def check(self, n: int) -> None:
        raise ConfigurationError(f"not {n}")


class AcceptsZero(Mean):
    def check(self, n: int) -> None:
        pass


class RefusesWithoutAMessage(Mean):
    def check(self, n: int) -> None:
        if n < 1:
            raise ConfigurationError


class RefusesWithAnotherError(Mean):
    def check(self, n: int) -> None:
        if n < 1:
            raise ValueError(n)


@pytest.mark.parametrize(
    ("component", "law"),
    [
        (First(), ORDER),
        (UnsortedMean(), ORDER),
        (Product(), VALUES),
        (AsList(), VALUES),
        (Single(), VALUES),
        (OneForEachMeeting(), VALUES),
        (OfTheFirstPopulation(), VALUES),
        (SpoiltByDivergence(), DIVERGED),
        (ChangesScores(), NOT_CHANGED),
        (ChangesMeetings(), NOT_CHANGED),
        (Random(), SAME),
        (SeedsGlobally(), SAME),
        (AcceptsNothing(), COUNTS),
        (AcceptsZero(), COUNTS),
        (RefusesWithoutAMessage(), COUNTS),
    ],
    ids=name_of,
)
def test_a_broken_credit_is_caught(component: Any, law: str, breaks: Callable[..., None]) -> None:
    breaks(CreditContract, component, law)


def test_a_refusal_by_another_error_is_caught(breaks: Callable[..., None]) -> None:
    breaks(CreditContract, RefusesWithAnotherError(), COUNTS, error=ValueError)


class NeedsThreePopulations(Mean):
    def credit(self, meetings: ScoredMeetings, population: int) -> Any:
        assert len(meetings.populations) == 3
        return super().credit(meetings, population)


class TestNeedsThreePopulations(CreditContract):
    component = NeedsThreePopulations()
    populations = range(3, 4)


def test_the_turns_of_the_contract_are_possible(keeps: Callable[..., None]) -> None:
    """Meetings are unique, indices are valid, and each credited individual has as many as it may have."""
    seen = set()

    class Inspects(OnlyThree):
        def credit(self, meetings: ScoredMeetings, population: int) -> Any:
            rows = meetings.meetings
            assert len(np.unique(rows, axis=0)) == len(rows) == len(meetings.scores)
            assert (rows < [len(members) for members in meetings.members]).all()
            assert set(rows[:, population].tolist()) == set(range(meetings.present[population]))
            everybody = math.prod(meetings.present) == len(rows)
            own = meetings.of(population)
            assert everybody or all(len(indices) == 3 for indices in own)
            teams = {tuple(map(tuple, np.delete(rows[indices], population, axis=1))) for indices in own}
            archived = (rows >= list(meetings.present)).any()
            seen.add((everybody, len(own) > 1 and len(teams) == 1, bool(archived)))
            return super().credit(meetings, population)

    keeps(CreditContract, Inspects(), VALUES)
    everybody, common, archived = (set(column) for column in zip(*seen, strict=True))
    assert everybody == common == archived == {False, True}
