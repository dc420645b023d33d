import itertools
from collections.abc import Callable
from typing import Any, ClassVar

import attrs
import numpy as np
import pytest
from contracts import name_of

from evoframe import Outcome, Record
from evoframe.testing import ObjectiveContract

RECORD = "test_its_record_has_tracks"
FINITE = "test_the_score_is_finite"
SAME = "test_the_same_outcome_has_the_same_score"
NOT_CHANGED = "test_the_outcome_is_not_changed"
WINDOW = "test_the_window_consists_of_two_samples"
OUTSIDE = "test_samples_outside_the_window_do_not_matter"


@attrs.frozen
class Rise:
    """A valid objective, and the base of the broken ones."""

    record: ClassVar[Record] = Record(("tip",))

    def score(self, outcome: Outcome) -> Any:
        return float(outcome.tracks["tip"][-1, 2] - outcome.tracks["tip"][0, 2])


class RiseAtTwoSamples(Rise):
    record = Record(("tip", "base"), every=0.01, samples=(0, 5), initial=True)

    def score(self, outcome: Outcome) -> Any:
        assert outcome.steps.tolist() == [0, 1, 6]
        assert outcome.times.tolist() == [0, 0.01, 0.06]
        return float(outcome.tracks["tip"][2, 2] - outcome.tracks["base"][1, 2])


@attrs.frozen
class RiseAfterASecond(Rise):
    """Requires a simulation of at least one second."""

    record: ClassVar[Record] = Record(("tip",), until=1.0)

    def score(self, outcome: Outcome) -> Any:
        late = outcome.tracks["tip"][outcome.times >= 1.0]
        return float(late[-1, 2] - late[0, 2])


class TestRiseAfterASecond(ObjectiveContract):
    component = RiseAfterASecond()


@attrs.frozen
class RiseAtTheEnd(Rise):
    """Uses the last two samples only."""

    def window(self, times: Any) -> Any:
        return float(times[max(len(times) - 2, 0)]), float(times[-1])

    def score(self, outcome: Outcome) -> Any:
        late = outcome.tracks["tip"][-2:, 2]
        return float(late[-1] - late[0])


class TestRiseAtTheEnd(ObjectiveContract):
    component = RiseAtTheEnd()


class LooksPastTheEnd(Rise):
    def window(self, times: Any) -> Any:
        return float(times[0]), float(times[-1]) + 1


class LooksBackwards(RiseAtTheEnd):
    def window(self, times: Any) -> Any:
        return super().window(times)[::-1]


class LooksAtMoreThanItSays(Rise):
    def window(self, times: Any) -> Any:
        return float(times[-1]), float(times[-1])


class TestRise(ObjectiveContract):
    component = Rise()


class TestRiseAtTwoSamples(ObjectiveContract):
    component = RiseAtTwoSamples()


class NothingRecorded(Rise):
    record = Record(())


class Relative(Rise):
    """Divides by zero if nothing moves."""

    def score(self, outcome: Outcome) -> Any:
        tip = outcome.tracks["tip"]
        with np.errstate(invalid="ignore"):
            return float(np.float64(super().score(outcome)) / np.ptp(tip))


class Whole(Rise):
    def score(self, outcome: Outcome) -> Any:
        return round(super().score(outcome))


class Counts(Rise):
    calls: ClassVar[Any] = itertools.count()

    def score(self, outcome: Outcome) -> Any:
        return float(next(self.calls))


class Centers(Rise):
    def score(self, outcome: Outcome) -> Any:
        outcome.tracks["tip"][:] -= outcome.tracks["tip"].mean() + 1
        return super().score(outcome)


@pytest.mark.parametrize(
    ("component", "law"),
    [
        (NothingRecorded(), RECORD),
        (Relative(), FINITE),
        (Whole(), FINITE),
        (Counts(), SAME),
        (Centers(), NOT_CHANGED),
        (LooksPastTheEnd(), WINDOW),
        (LooksBackwards(), WINDOW),
        (LooksAtMoreThanItSays(), OUTSIDE),
    ],
    ids=name_of,
)
def test_a_broken_objective_is_caught(component: Any, law: str, breaks: Callable[..., None]) -> None:
    breaks(ObjectiveContract, component, law)
