from typing import Any

import attrs
import pytest
from collaborators import chosen, members_of, population
from hypothesis import given, strategies as st

from evoframe import Member
from evoframe_strategies import All, BestAndWorst, Fittest, SpeciesChampions, Worst


@pytest.mark.parametrize(
    ("strategy", "expected"),
    [
        (Fittest(n=3), [4, 0, 2]),
        (Worst(n=3), [3, 1, 0]),
        (BestAndWorst(n=2), [4, 0, 3, 1]),
        (BestAndWorst(n=3), [4, 0, 2, 3, 1, 5]),
        (SpeciesChampions(n=3), [4, 0, 2]),
        (All(), [0, 1, 2, 3, 4, 5]),
    ],
)
def test_members_are_chosen_by_fitness_and_ties_by_index(strategy: Any, expected: list[int]) -> None:
    assert chosen(strategy, population(0.5, -0.1, 0.5, -0.2, 0.9, 0.5)) == expected


@pytest.mark.parametrize(
    ("strategy", "expected"),
    [
        (Fittest(n=2), [1, 3]),
        (Fittest(n=3), [1, 3, 0]),
        (Fittest(n=4), [1, 3, 0, 2]),
        (Worst(n=2), [3, 1]),
        (Worst(n=3), [3, 1, 2]),
        (BestAndWorst(n=1), [1, 3]),
        (BestAndWorst(n=2), [1, 3, 2, 0]),
        (SpeciesChampions(n=3), [1, 3, 0]),
    ],
)
def test_diverged_members_are_a_last_resort(strategy: Any, expected: list[int]) -> None:
    assert chosen(strategy, population(0.9, 0.6, -0.9, 0.5, diverged=(0, 2))) == expected


def of_species(*species: int | None) -> list[Member]:
    """Return members of these species, the fittest first."""
    members = population(*range(len(species), 0, -1))
    return [attrs.evolve(member, species=s) for member, s in zip(members, species, strict=True)]


def test_a_champion_of_each_species_comes_before_the_others() -> None:
    members = of_species(1, 1, 1, 2, 2, 3)
    assert [chosen(SpeciesChampions(n=n), members) for n in (2, 3, 5)] == [[0, 3], [0, 3, 5], [0, 3, 5, 1, 2]]


def test_a_champion_that_diverged_is_not_one() -> None:
    one, two, three = of_species(1, 2, 1)
    diverged = attrs.evolve(two, diverged=True)
    assert chosen(SpeciesChampions(n=2), [one, diverged, three]) == [0, 2]


@given(members_of(), st.data())
def test_without_species_the_champions_are_the_fittest(members: list[Member], data: st.DataObject) -> None:
    n = data.draw(st.integers(1, len(members)))
    members = [attrs.evolve(member, species=None) for member in members]
    assert chosen(SpeciesChampions(n=n), members) == chosen(Fittest(n=n), members)


@given(members_of(), st.data())
def test_no_species_is_represented_twice_before_all_are_once(
    members: list[Member], data: st.DataObject
) -> None:
    clean = {member.species for member in members if not member.diverged}
    n = data.draw(st.integers(1, len(members)))
    species = [members[i].species for i in chosen(SpeciesChampions(n=n), members)]
    first = species[: len(clean)]
    assert len(set(first)) == len(first)


@given(members_of())
def test_all_is_everybody(members: list[Member]) -> None:
    assert All().size(len(members)) == len(members)
    assert sorted(chosen(Fittest(n=len(members)), members)) == chosen(All(), members)
