import random
from collections.abc import Callable, Sequence
from typing import Any

import attrs
import numpy as np
import pytest
from contracts import name_of

from evoframe import ConfigurationError, Judged, Member
from evoframe.testing import CollaborationStrategyContract

REFUSALS = "test_populations_are_refused_by_a_configuration_error_that_names_their_size"
DECLARED = "test_no_more_collaborators_than_members_are_declared"
COUNT = "test_as_many_as_declared_are_chosen"
VALID = "test_indices_are_valid"
ONCE = "test_no_member_is_chosen_twice"
SAME = "test_the_same_random_state_gives_the_same_choice"
TIES = "test_ties_are_broken_by_index"
CLEAN = "test_no_diverged_member_is_chosen_while_a_clean_one_is_left"
NUMBERS = "test_all_possible_numbers_are_declared"
ROWS = "test_there_is_a_row_for_each_individual"
IDS = "test_ids_are_irrelevant_to_choices_for_each_individual"


@attrs.frozen
class Two:
    """A valid strategy, which chooses the two fittest, and the base of the broken ones."""

    def size(self, n_members: int) -> int:
        if n_members < 2:
            raise ConfigurationError(f"2 of {n_members} members")
        return 2

    def select(self, members: Sequence[Member], rng: np.random.Generator) -> Any:
        self.size(len(members))
        return np.array(self.ranked(members, rng)[:2], dtype=np.intp)

    def ranked(self, members: Sequence[Member], rng: np.random.Generator) -> list[int]:
        return sorted(range(len(members)), key=lambda i: (members[i].diverged, -(members[i].fitness or 0), i))


class TestTwo(CollaborationStrategyContract):
    component = Two()


class AnyTwo(Two):
    def ranked(self, members: Sequence[Member], rng: np.random.Generator) -> list[int]:
        order = rng.permutation(len(members)).tolist()
        return sorted(order, key=lambda i: members[i].diverged)


class TestAnyTwo(CollaborationStrategyContract):
    component = AnyTwo()


class Repeats(Two):
    def select(self, members: Sequence[Member], rng: np.random.Generator) -> Any:
        return super().select(members, rng)[[0, 0]]


class OneTooMany(Two):
    def select(self, members: Sequence[Member], rng: np.random.Generator) -> Any:
        return np.array(self.ranked(members, rng)[:3], dtype=np.intp)


class OtherType(Two):
    def select(self, members: Sequence[Member], rng: np.random.Generator) -> Any:
        return super().select(members, rng).astype(np.float64)


class FromTheEnd(Two):
    def select(self, members: Sequence[Member], rng: np.random.Generator) -> Any:
        return super().select(members, rng) - len(members)


class PythonsRandom(Two):
    def ranked(self, members: Sequence[Member], rng: np.random.Generator) -> list[int]:
        return random.sample(range(len(members)), len(members))


class NumpysRandom(Two):
    def ranked(self, members: Sequence[Member], rng: np.random.Generator) -> list[int]:
        return list(np.random.permutation(len(members)))  # noqa: NPY002


class FreshRandom(Two):
    def ranked(self, members: Sequence[Member], rng: np.random.Generator) -> list[int]:
        return list(np.random.default_rng().permutation(len(members)))


class LastOfEquals(Two):
    def ranked(self, members: Sequence[Member], rng: np.random.Generator) -> list[int]:
        return sorted(range(len(members)), key=lambda i: (members[i].diverged, members[i].fitness, i))[::-1]


class TiesById(Two):
    def ranked(self, members: Sequence[Member], rng: np.random.Generator) -> list[int]:
        order = super().ranked(members, rng)
        return sorted(order, key=lambda i: (members[i].diverged, -(members[i].fitness or 0), members[i].id))


class TakesDiverged(Two):
    def ranked(self, members: Sequence[Member], rng: np.random.Generator) -> list[int]:
        return sorted(range(len(members)), key=lambda i: (-(members[i].fitness or 0), i))


class PromisesTooMuch(Two):
    def size(self, n_members: int) -> int:
        return 2


class PromisesNothing(Two):
    def size(self, n_members: int) -> int:
        return 0


class AcceptsNobody(Two):
    def size(self, n_members: int) -> int:
        raise ConfigurationError(f"not {n_members}")


class RefusesWithoutNumbers(Two):
    def size(self, n_members: int) -> int:
        if n_members < 2:
            raise ConfigurationError("too few")
        return 2


class RefusesWithAnotherError(Two):
    def size(self, n_members: int) -> int:
        if n_members < 2:
            raise ValueError(n_members)
        return 2


class Neighbors(Two):
    """A valid strategy for each individual, and the base of the broken ones: the members beside its index."""

    def select_each(
        self, judged: Sequence[Judged], members: Sequence[Member], rng: np.random.Generator
    ) -> Any:
        size = self.size(len(members))
        rows = [self.row(one, members)[:size] for one in judged]
        return np.array(rows, dtype=np.intp).reshape(len(judged), size)

    def row(self, one: Judged, members: Sequence[Member]) -> list[int]:
        around = [(one.index + step) % len(members) for step in range(len(members))]
        return sorted(around, key=lambda index: members[index].diverged)


class TestNeighbors(CollaborationStrategyContract):
    component = Neighbors()


class FloatRows(Neighbors):
    def select_each(self, judged: Any, members: Any, rng: Any) -> Any:
        return super().select_each(judged, members, rng).astype(np.float64)


class OneRowForAll(Neighbors):
    def select_each(self, judged: Any, members: Any, rng: Any) -> Any:
        return super().select_each([Judged(members[0], index=0)], members, rng)


class RepeatsInARow(Neighbors):
    def select_each(self, judged: Any, members: Any, rng: Any) -> Any:
        return super().select_each(judged, members, rng)[:, [0, 0]]


class NearestIds(Neighbors):
    def row(self, one: Judged, members: Sequence[Member]) -> list[int]:
        return sorted(range(len(members)), key=lambda index: (members[index].diverged, members[index].id))


class SmallestIdOfJudged(Neighbors):
    def row(self, one: Judged, members: Sequence[Member]) -> list[int]:
        return super().row(attrs.evolve(one, index=one.member.id), members)


class TwoOrThree(Two):
    """A valid strategy with two possible numbers, and the base of the broken ones."""

    def sizes(self, n_members: int) -> Sequence[int]:
        self.size(n_members)
        return [3, 2]


class TestTwoOrThree(CollaborationStrategyContract):
    component = TwoOrThree()


class WithoutItsSize(TwoOrThree):
    def sizes(self, n_members: int) -> Sequence[int]:
        self.size(n_members)
        return [3]


class PossiblyNobody(TwoOrThree):
    def sizes(self, n_members: int) -> Sequence[int]:
        self.size(n_members)
        return [0, 2]


class RefusesMoreThanItsSize(TwoOrThree):
    def sizes(self, n_members: int) -> Sequence[int]:
        if n_members < 3:
            raise ConfigurationError(f"3 of {n_members} members")
        return [2, 3]


class RefusesNumbersWithoutNumbers(TwoOrThree):
    def sizes(self, n_members: int) -> Sequence[int]:
        if n_members < 2:
            raise ConfigurationError("too few")
        return [2, 3]


@pytest.mark.parametrize(
    ("component", "law"),
    [
        (WithoutItsSize(), NUMBERS),
        (PossiblyNobody(), NUMBERS),
        (RefusesMoreThanItsSize(), NUMBERS),
        (RefusesNumbersWithoutNumbers(), NUMBERS),
        (FloatRows(), ROWS),
        (OneRowForAll(), ROWS),
        (RepeatsInARow(), ONCE),
        (NearestIds(), IDS),
        (SmallestIdOfJudged(), IDS),
        (Repeats(), ONCE),
        (OneTooMany(), COUNT),
        (OtherType(), COUNT),
        (FromTheEnd(), VALID),
        (PythonsRandom(), SAME),
        (NumpysRandom(), SAME),
        (FreshRandom(), SAME),
        (LastOfEquals(), TIES),
        (TiesById(), TIES),
        (TakesDiverged(), CLEAN),
        (PromisesTooMuch(), DECLARED),
        (PromisesNothing(), DECLARED),
        (AcceptsNobody(), REFUSALS),
        (RefusesWithoutNumbers(), REFUSALS),
    ],
    ids=name_of,
)
def test_a_broken_strategy_is_caught(component: Any, law: str, breaks: Callable[..., None]) -> None:
    breaks(CollaborationStrategyContract, component, law)


def test_a_refusal_by_another_error_is_caught(breaks: Callable[..., None]) -> None:
    breaks(CollaborationStrategyContract, RefusesWithAnotherError(), REFUSALS, error=ValueError)
