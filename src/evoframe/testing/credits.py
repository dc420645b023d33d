"""The laws of credit."""

from __future__ import annotations

import itertools
import math
from typing import ClassVar

import attrs
import numpy as np
from hypothesis import strategies as st
from numpy.typing import NDArray

from evoframe.contract import Credit, Member, ScoredMeetings
from evoframe.testing.components import ComponentContract
from evoframe.testing.laws import (
    accepted,
    for_all,
    global_random_state_untouched,
    refusal,
    same_bits,
)

__all__ = ["CreditContract"]

LARGEST = 1e100


@attrs.frozen(eq=False)
class Case:
    """Arguments of :meth:`Credit.credit`."""

    meetings: ScoredMeetings
    population: int


class CreditContract(ComponentContract[Credit]):
    """The laws of a :class:`~evoframe.Credit`.

    Attributes:
        counts: Numbers of collaborators to test; those that ``check`` refuses are not credited.
        populations: Numbers of populations to test.
    """

    protocol = Credit
    counts: ClassVar[range] = range(-1, 13)
    populations: ClassVar[range] = range(2, 4)

    def test_numbers_of_collaborators_are_refused_by_a_configuration_error(self) -> None:
        """``check`` raises only ``ConfigurationError`` with a message; it refuses n < 1, but not all n."""
        for n in self.counts:
            assert refusal(self.component.check, n) != "", f"check({n}) raises an error without a message"
        counts = accepted(self.component.check, self.counts)
        assert counts, f"check() refuses every n in {self.counts}; accept at least one, or override 'counts'"
        assert min(counts) >= 1, f"check() must refuse n < 1, but accepts {min(counts)}"

    def test_each_member_has_one_finite_value(self) -> None:
        """Finite scores of any magnitude up to 1e100 give ``float64[present]``, all finite."""

        def law(case: Case) -> None:
            fitness = self._credit(case)
            present = (case.meetings.present[case.population],)
            assert isinstance(fitness, np.ndarray), (
                f"credit() must return an array, found {type(fitness).__name__}"
            )
            assert fitness.dtype == np.float64, f"credit() must return float64, found {fitness.dtype}"
            assert fitness.shape == present, f"credit() must return shape {present}, found {fitness.shape}"
            assert np.isfinite(fitness).all(), f"credit() must be finite for finite scores, found {fitness}"

        for_all(law, case=self.cases())

    def test_the_order_of_the_meetings_is_irrelevant(self) -> None:
        """The result does not depend on the order of the meetings, to the last bit."""

        def law(case: Case, seed: int) -> None:
            order = np.random.default_rng(seed).permutation(len(case.meetings.scores))
            assert same_bits(self._credit(case), self._credit(_ordered(case, order))), (
                "credit() depends on the order of the meetings; sort scores, or sum with math.fsum()"
            )

        for_all(law, case=self.cases(), seed=st.integers(0, 2**32 - 1))

    def test_a_diverged_meeting_spoils_no_other_member(self) -> None:
        """Members without a diverged meeting have a finite value; also those who share a collaborator."""

        def law(case: Case) -> None:
            fitness = self._credit(case)
            for index, own in enumerate(case.meetings.of(case.population)):
                if not np.isnan(case.meetings.scores[own]).any():
                    assert math.isfinite(fitness[index]), (
                        f"no meeting of member {index} diverged, but its value is {fitness[index]}; ignore "
                        "scores of others that are NaN"
                    )

        for_all(law, case=self.cases(diverged=True))

    def test_the_meetings_are_not_changed(self) -> None:
        """``credit`` does not change its argument."""

        def law(case: Case) -> None:
            scores, meetings = case.meetings.scores.copy(), case.meetings.meetings.copy()
            self._credit(case)
            changes = "credit() changes its argument; work on a copy"
            assert same_bits(case.meetings.scores, scores), changes
            assert same_bits(case.meetings.meetings, meetings), changes

        for_all(law, case=self.cases(diverged=True))

    def test_the_same_meetings_give_the_same_values(self) -> None:
        """The result depends on the meetings only; global random generators are neither used nor seeded."""

        def law(case: Case) -> None:
            with global_random_state_untouched():
                first, second = self._credit(case), self._credit(case)
            assert same_bits(first, second), "credit() differs for the same meetings"

        for_all(law, case=self.cases(diverged=True))

    def cases(self, *, diverged: bool = False) -> st.SearchStrategy[Case]:
        """Return turns, and a population to credit; every kind of choice of collaborators occurs.

        Args:
            diverged: Whether some simulations diverged.
        """
        counts = st.sampled_from(accepted(self.component.check, self.counts))
        structures = st.builds(
            _structure,
            n_populations=st.sampled_from(self.populations),
            n=counts,
            everybody=st.booleans(),
            turn=st.integers(0, 400),
            seed=st.integers(0, 2**32 - 1),
        )
        return structures.flatmap(
            lambda case: _scores(len(case.meetings.meetings), diverged).map(
                lambda scores: attrs.evolve(case, meetings=attrs.evolve(case.meetings, scores=scores))
            )
        )

    def _credit(self, case: Case) -> NDArray[np.float64]:
        return self.component.credit(case.meetings, case.population)


def _structure(n_populations: int, n: int, turn: int, seed: int, *, everybody: bool) -> Case:
    """Return a turn without scores.

    Args:
        n_populations: Number of populations.
        n: Number of meetings of each member of the credited population; others may be archived.
        everybody: All members meet instead, as in the initial turn.
        turn: Index of the turn.
        seed: Seed of sizes and choices.
    """
    rng = np.random.default_rng(seed)
    population = int(rng.integers(n_populations))
    sizes = [int(size) for size in rng.integers(1, 4, n_populations)]
    largest = max((role for role in range(n_populations) if role != population), key=sizes.__getitem__)
    sizes[largest] = max(sizes[largest], n)
    archived = [0 if role == population else int(rng.integers(2)) for role in range(n_populations)]
    if everybody:
        rows = list(itertools.product(*map(range, sizes)))
    else:
        rows = _chosen(sizes, archived, population, n, rng)
    return Case(
        ScoredMeetings(
            turn,
            tuple(f"role {role}" for role in range(n_populations)),
            tuple(
                tuple(Member(id_, None if role == population else rng.normal()) for id_ in range(size + more))
                for role, (size, more) in enumerate(zip(sizes, archived, strict=True))
            ),
            tuple(sizes),
            np.array(rows, dtype=np.intp),
            np.zeros(len(rows)),
        ),
        population,
    )


def _chosen(
    sizes: list[int], archived: list[int], population: int, n: int, rng: np.random.Generator
) -> list[tuple[int, ...]]:
    """Return *n* meetings of each member of a population, with the same collaborators or with its own."""
    pools = [
        range(1) if role == population else range(size + more)
        for role, (size, more) in enumerate(zip(sizes, archived, strict=True))
    ]
    teams = list(itertools.product(*pools))
    common = rng.permutation(len(teams))[:n] if rng.integers(2) else None
    rows = []
    for member in range(sizes[population]):
        for index in rng.permutation(len(teams))[:n] if common is None else common:
            team = teams[index]
            rows.append((*team[:population], member, *team[population + 1 :]))
    return rows


def _scores(n: int, diverged: bool) -> st.SearchStrategy[NDArray[np.float64]]:
    """Return *n* scores of all magnitudes; half of the arrays contain only two values, with many ties."""
    score = st.floats(-LARGEST, LARGEST) | st.sampled_from(
        [-LARGEST, -0.01, 0.0, 5e-324, 0.004, 1.0, LARGEST]
    )
    any_score = score | st.just(math.nan) if diverged else score
    two_values = st.tuples(any_score, score).map(st.sampled_from)
    lists = st.lists(any_score, min_size=n, max_size=n) | two_values.flatmap(
        lambda value: st.lists(value, min_size=n, max_size=n)
    )
    return lists.map(lambda scores: np.array(scores, dtype=np.float64))


def _ordered(case: Case, order: NDArray[np.int64]) -> Case:
    """Return the same turn with its meetings in another order."""
    meetings = attrs.evolve(
        case.meetings, meetings=case.meetings.meetings[order], scores=case.meetings.scores[order]
    )
    return attrs.evolve(case, meetings=meetings)
