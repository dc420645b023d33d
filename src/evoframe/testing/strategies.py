"""The laws of collaboration strategies."""

from __future__ import annotations

from typing import Any, ClassVar

import attrs
import numpy as np
from hypothesis import strategies as st
from numpy.typing import NDArray

from evoframe.contract import CollaborationStrategy, Member
from evoframe.testing.components import ComponentContract
from evoframe.testing.laws import accepted, for_all, global_random_state_untouched, refusal

__all__ = ["CollaborationStrategyContract"]

_SEEDS = st.integers(0, 2**32 - 1)


class CollaborationStrategyContract(ComponentContract[CollaborationStrategy]):
    """The laws of a :class:`~evoframe.CollaborationStrategy`.

    Attributes:
        population_sizes: Sizes of populations to test; no members are selected from those that ``size``
            refuses.
    """

    protocol = CollaborationStrategy
    population_sizes: ClassVar[range] = range(1, 17)

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
        """Of members that differ only in their ids, the first is chosen first, unless choices are random."""

        def law(members: list[Member], seed: int) -> None:
            rng = np.random.default_rng(seed)
            chosen = self.component.select(members, rng).tolist()
            if not _was_used(rng, seed):
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

    def populations(self) -> st.SearchStrategy[list[Member]]:
        """Return evaluated populations of accepted sizes, with many ties and some diverged members."""
        sizes = st.sampled_from(accepted(self.component.size, self.population_sizes))
        return sizes.flatmap(_members)

    def _select(self, members: Any, seed: int) -> NDArray[np.intp]:
        return self.component.select(members, np.random.default_rng(seed))


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
