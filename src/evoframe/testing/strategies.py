"""The laws of collaboration strategies."""

from __future__ import annotations

from typing import Any

import attrs
import numpy as np
from hypothesis import strategies as st
from numpy.typing import NDArray

from evoframe.contract import Judged, Member, SupportsEach, SupportsMemory, SupportsSizes
from evoframe.testing.laws import accepted, for_all, global_random_state_untouched, refusal
from evoframe.testing.strategy_runs import StrategyRunLaws

__all__ = ["CollaborationStrategyContract"]

_SEEDS = st.integers(0, 2**32 - 1)
_SOMEBODY = Judged(Member(id=0, fitness=None), index=0)
_JUDGED = st.lists(
    st.builds(
        Judged,
        st.builds(Member, id=st.integers(0, 16), fitness=st.none() | st.floats(-1.0, 1.0)),
        collaborators=st.lists(st.integers(0, 16), max_size=3, unique=True).map(tuple),
        index=st.integers(0, 16),
    ),
    max_size=6,
    unique_by=lambda judged: judged.index,
)


class CollaborationStrategyContract(StrategyRunLaws):
    """The laws of a :class:`~evoframe.CollaborationStrategy` and of its :class:`~evoframe.CollaborationRun`.

    Choices for each individual, a memory, and several numbers of collaborators are tested if the strategy
    offers them. The method ``select`` of a strategy with a memory or with choices for each individual is not
    called; its first choice for an individual is tested instead.

    Attributes:
        population_sizes: Sizes of populations to test; no members are selected from those that ``size``
            refuses.
        turns: Number of turns of the choosing population in a simulated run.
    """

    def test_populations_are_refused_by_a_configuration_error_that_names_their_size(self) -> None:
        """``size`` raises only ``ConfigurationError``, and accepts some population sizes."""
        refusals = {n: refusal(self.component.size, n) for n in self.population_sizes}
        assert None in refusals.values(), (
            f"size() refuses every population in {self.population_sizes}; "
            "accept at least one, or override 'population_sizes'"
        )
        for n_members, message in refusals.items():
            assert message is None or str(n_members) in message, (
                f"the message with which size() refuses {n_members} members must contain that number"
            )

    def test_no_more_collaborators_than_members_are_declared(self) -> None:
        """``size`` is between 1 and the population size; smaller populations are refused."""
        for n_members in accepted(self.component.size, self.population_sizes):
            declared = self.component.size(n_members)
            assert 1 <= declared <= n_members, (
                f"size({n_members}) must be between 1 and {n_members} or raise a ConfigurationError, "
                f"found {declared}"
            )

    def test_as_many_as_declared_are_chosen(self) -> None:
        """``select`` returns an array ``intp[size(len(members))]``."""

        def law(members: list[Member], seed: int) -> None:
            chosen = self._select(members, seed)
            assert chosen.dtype == np.intp, f"select() must return an intp array, found {chosen.dtype}"
            declared = (self.component.size(len(members)),)
            assert chosen.shape == declared, f"select() must return shape {declared}, found {chosen.shape}"

        for_all(law, members=self.populations(), seed=_SEEDS)

    def test_indices_are_valid(self) -> None:
        """Each chosen index is that of a member."""

        def law(members: list[Member], seed: int) -> None:
            invalid = set(self._select(members, seed).tolist()) - set(range(len(members)))
            assert not invalid, f"expected indices from 0 to {len(members) - 1}, found {sorted(invalid)}"

        for_all(law, members=self.populations(), seed=_SEEDS)

    def test_no_member_is_chosen_twice(self) -> None:
        """Collaborators are different members."""

        def law(members: list[Member], seed: int) -> None:
            chosen = self._select(members, seed).tolist()
            assert len(set(chosen)) == len(chosen), f"expected different indices, found {chosen}"

        for_all(law, members=self.populations(), seed=_SEEDS)

    def test_the_same_random_state_gives_the_same_choice(self) -> None:
        """The choice depends on the members and the given generator only."""

        def law(members: list[Member], seed: int) -> None:
            with global_random_state_untouched():
                first = self._select(members, seed)
                second = self._select(tuple(members), seed)
            assert first.tolist() == second.tolist(), (
                "the same members and random state give different choices"
            )

        for_all(law, members=self.populations(), seed=_SEEDS)

    def test_ties_are_broken_by_index(self) -> None:
        """Of members that differ only in their ids, the first is chosen first.

        Exceptions are random choices, and choices for each individual, for which only ids must be irrelevant.
        """

        def law(members: list[Member], seed: int) -> None:
            rng = np.random.default_rng(seed)
            chosen = self._select_with(members, rng).tolist()
            if not isinstance(self.component, SupportsEach) and not _was_used(rng, seed):
                for index in chosen:
                    twins = [i for i in range(index) if _are_equal(members[i], members[index])]
                    before = chosen[: chosen.index(index)]
                    assert set(twins) <= set(before), (
                        f"ties must be broken by index: expected {twins} before {index}, since these members "
                        f"differ only in their ids; found {chosen}"
                    )

        for_all(law, members=self.populations(), seed=_SEEDS)

    def test_no_diverged_member_is_chosen_while_a_clean_one_is_left(self) -> None:
        """Members with a diverged simulation are chosen last."""

        def law(members: list[Member], seed: int) -> None:
            chosen = self._select(members, seed).tolist()
            if any(members[index].diverged for index in chosen):
                clean = [index for index, member in enumerate(members) if not member.diverged]
                assert set(clean) <= set(chosen), (
                    f"choose all clean members {clean} before a diverged one; found {chosen}"
                )

        for_all(law, members=self.populations(), seed=_SEEDS)

    def test_all_possible_numbers_are_declared(self) -> None:
        """``sizes`` returns positive numbers, also that of ``size``, and refuses the same populations."""
        if isinstance(self.component, SupportsSizes):
            for n_members in self.population_sizes:
                refused = refusal(self.component.sizes, n_members)
                assert (refused is None) == (refusal(self.component.size, n_members) is None), (
                    f"size({n_members}) and sizes({n_members}) must both be accepted or both be refused"
                )
                assert refused is None or str(n_members) in refused, (
                    f"the message with which sizes() refuses {n_members} members must contain that number"
                )
            for n_members in accepted(self.component.sizes, self.population_sizes):
                declared, first = list(self.component.sizes(n_members)), self.component.size(n_members)
                assert first in declared, f"sizes({n_members}) must contain size({n_members}) = {first}"
                assert min(declared) >= 1, f"expected numbers >= 1, found sizes({n_members}) = {declared}"

    def test_there_is_a_row_for_each_individual(self) -> None:
        """``select_each`` returns an array ``intp[len(judged), size(len(members))]``, even for nobody."""

        def law(members: list[Member], judged: list[Judged], seed: int) -> None:
            rows = self._select_each(judged, members, seed)
            assert rows.dtype == np.intp, f"select_each() must return an intp array, found {rows.dtype}"
            declared = (len(judged), self.component.size(len(members)))
            assert rows.shape == declared, f"select_each() must return shape {declared}, found {rows.shape}"

        if isinstance(self.component, SupportsEach):
            for_all(law, members=self.populations(), judged=_JUDGED, seed=_SEEDS)

    def test_ids_are_irrelevant_to_choices_for_each_individual(self) -> None:
        """``select_each`` returns the same rows if all ids are replaced: they break no ties."""

        def law(members: list[Member], judged: list[Judged], seed: int) -> None:
            renamed = [attrs.evolve(member, id=_other_id(member.id)) for member in members]
            rows = self._select_each(judged, members, seed).tolist()
            again = self._select_each([*map(_renamed, judged)], renamed, seed).tolist()
            assert rows == again, "other ids give other choices; break ties by index"

        if isinstance(self.component, SupportsEach):
            for_all(law, members=self.populations(), judged=_JUDGED, seed=_SEEDS)

    def populations(self) -> st.SearchStrategy[list[Member]]:
        """Return evaluated populations of accepted sizes, with many ties and some diverged members."""
        return self._accepted_sizes().flatmap(_members)

    def _select(self, members: Any, seed: int) -> NDArray[np.intp]:
        return self._select_with(members, np.random.default_rng(seed))

    def _select_with(self, members: Any, rng: np.random.Generator) -> NDArray[np.intp]:
        """Return the choice for an individual, by the method that is called in a run."""
        if isinstance(self.component, SupportsMemory):
            [row] = self.start().choose([_SOMEBODY], members, rng)
            return np.array(row)
        if isinstance(self.component, SupportsEach):
            [chosen] = self.component.select_each([_SOMEBODY], members, rng)
            return np.asarray(chosen)
        return self.component.select(members, rng)

    def _select_each(self, judged: list[Judged], members: list[Member], seed: int) -> NDArray[np.intp]:
        assert isinstance(self.component, SupportsEach)
        return self.component.select_each(judged, members, np.random.default_rng(seed))


def _members(n: int) -> st.SearchStrategy[list[Member]]:
    fitness = st.sampled_from([-1.0, 0.0, 0.004, 0.005]) | st.floats(-1e100, 1e100)
    member = st.builds(
        Member,
        id=st.just(0),
        fitness=fitness,
        species=st.none() | st.integers(1, 3),
        genome_size=st.integers(1, 3),
        age=st.integers(0, 2),
        diverged=st.booleans(),
    )
    equals = member.map(lambda one: [one] * n)
    return st.builds(_with_ids, st.lists(member, min_size=n, max_size=n) | equals, st.permutations(range(n)))


def _with_ids(members: list[Member], ids: list[int]) -> list[Member]:
    return [attrs.evolve(member, id=id_) for member, id_ in zip(members, ids, strict=True)]


def _are_equal(one: Member, other: Member) -> bool:
    return attrs.evolve(one, id=other.id) == other


def _was_used(rng: np.random.Generator, seed: int) -> bool:
    return bool(rng.bit_generator.state != np.random.default_rng(seed).bit_generator.state)


def _renamed(judged: Judged) -> Judged:
    member = attrs.evolve(judged.member, id=_other_id(judged.member.id))
    return attrs.evolve(judged, member=member, collaborators=tuple(map(_other_id, judged.collaborators)))


def _other_id(id_: int) -> int:
    return 1000 - id_  # reverses their order
