"""The current generation: its members, their ages and their fitness."""

from __future__ import annotations

import json
from types import SimpleNamespace
from typing import Any

import attrs
import numpy as np
import pytest
from hypothesis import given, strategies as st

from evoframe import StructureError, structure
from evoframe_evolvers.cohort import FITNESS_LIMIT, Cohort, SavedCohort


def genome(key: int) -> Any:
    return SimpleNamespace(key=key, fitness=None, size=lambda: (key, 2 * key))


def cohort_of(*keys: int) -> Cohort:
    return Cohort({key: genome(key) for key in keys})


def play(cohort: Cohort, *fitness: float) -> None:
    cohort.ask()
    cohort.tell(np.array(fitness))


def no_species(_: int) -> None:
    return None


def saved(cohort: Cohort) -> Any:
    return json.loads(json.dumps(cohort.state(lambda genome: {"id": genome.key})))


def again(state: Any, size: int | None = None) -> Cohort:
    document = structure(state, SavedCohort, ("cohort",))
    genomes = [genome(member.genome["id"]) for member in document.members]
    return Cohort.from_state(document, genomes, len(genomes) if size is None else size)


@given(st.lists(st.sets(st.integers(1, 9), min_size=1), min_size=1), st.data())
def test_age_and_fitness_are_kept_as_long_as_a_genome_stays(
    generations: list[set[int]], data: st.DataObject
) -> None:
    cohort, ages, known = cohort_of(*generations[0]), dict.fromkeys(generations[0], 0), dict[int, float]()
    for number, keys in enumerate(generations):
        if number:
            cohort.succeed({key: genome(key) for key in keys})
            ages = {key: ages[key] + 1 if key in ages else 0 for key in keys}
            known = {key: known[key] for key in keys if key in known}
        members = cohort.members(no_species)
        assert {member.id: member.age for member in members} == ages
        assert {member.id: member.fitness for member in members} == {key: known.get(key) for key in keys}
        fitness = [data.draw(st.floats(allow_nan=False, allow_infinity=False)) for _ in keys]
        play(cohort, *fitness)
        known = dict(zip(cohort.genomes, fitness, strict=True))


def test_a_turn_goes_from_asking_to_telling_to_the_next_generation() -> None:
    cohort = cohort_of(1, 2)
    assert not cohort.finished
    with pytest.raises(RuntimeError, match=r"^tell\(\) .*ask\(\)"):
        cohort.tell(np.zeros(2))
    assert [genome.key for genome in cohort.ask()] == [1, 2]
    with pytest.raises(RuntimeError, match=r"^ask\(\) .*tell\(\)"):
        cohort.ask()
    cohort.tell(np.zeros(2))
    assert cohort.finished
    cohort.succeed({3: genome(3), 4: genome(4)})
    assert (cohort.generation, cohort.finished) == (1, False)


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_fitness_is_limited_for_neat_python_only(fitness: float) -> None:
    cohort = cohort_of(1)
    play(cohort, fitness)
    assert cohort.genomes[1].fitness == min(max(fitness, -FITNESS_LIMIT), FITNESS_LIMIT)
    [member] = cohort.members(no_species)
    assert member.fitness == fitness


def test_members_have_their_species_and_their_size() -> None:
    [member] = cohort_of(3).members(lambda key: 10 * key)
    assert (member.species, member.genome_size) == (30, 9)


@pytest.mark.parametrize("turn", ["new", "asked", "told", "elite"])
def test_a_saved_cohort_is_the_same_again(turn: str) -> None:
    cohort = cohort_of(5, 2)
    if turn != "new":
        cohort.ask()
    if turn in ("told", "elite"):
        cohort.tell(np.array([0.25, -1e300]))
    if turn == "elite":
        cohort.succeed({2: cohort.genomes[2], 7: genome(7)})
    restored = again(saved(cohort))
    assert saved(restored) == saved(cohort)
    assert restored.members(no_species) == cohort.members(no_species)
    assert [one.fitness for one in restored.genomes.values()] == [
        other.fitness for other in cohort.genomes.values()
    ]


def test_a_member_of_the_future_is_refused() -> None:
    state = saved(cohort_of(5))
    state["members"][0]["born"] = 1
    with pytest.raises(ValueError, match=r"genome 5: .*generation 1, .* 0$"):
        again(state)


def test_a_told_member_without_fitness_is_refused() -> None:
    state = saved(cohort_of(5)) | {"phase": "told"}
    with pytest.raises(ValueError, match=r"all 1 genomes .*found 0$"):
        again(state)


@pytest.mark.parametrize(
    ("keys", "size", "found"),
    [((1, 1), 2, "2 genomes .* 1 "), ((1, 2), 3, "2 genomes .* 2 "), ((1,), 0, "1 genomes .* 1 ")],
)
def test_another_number_of_genomes_is_refused(keys: tuple[int, ...], size: int, found: str) -> None:
    state = saved(cohort_of(1))
    state["members"] = [state["members"][0] | {"genome": {"id": key}} for key in keys]
    with pytest.raises(ValueError, match=f"expected {size} genomes .*found {found}"):
        again(state, size)


@pytest.mark.parametrize(
    ("change", "fault"),
    [
        ({"generation": -1}, r"cohort\.generation: .*>= 0, found -1"),
        ({"phase": "lost"}, r'cohort\.phase: .*"new", "asked", "told", found "lost"'),
        ({"members": {}}, r"cohort\.members: .*list, found \{\}"),
        ({"members": [{"born": True, "fitness": None, "genome": {}}]}, r"members\[0\]\.born: .*whole number"),
        ({"members": [{"born": 0, "genome": {}}]}, r"members\[0\]\.fitness: .*missing"),
    ],
)
def test_a_fault_of_the_document_is_named(change: dict[str, Any], fault: str) -> None:
    with pytest.raises(StructureError, match=fault):
        again(saved(cohort_of(5)) | change)


def test_the_document_has_the_keys_of_a_state() -> None:
    assert {*saved(cohort_of(1))} == {field.name for field in attrs.fields(SavedCohort)}


@pytest.mark.parametrize("count", [0, 4])
def test_seeds_are_as_many_as_members_at_most(count: int) -> None:
    with pytest.raises(ValueError, match=f"1 to 3 seeds, found {count}"):
        cohort_of(1, 2, 3).check_seeds(count)
    cohort_of(1, 2, 3).check_seeds(1)
    cohort_of(1, 2, 3).check_seeds(3)


def test_seeds_come_before_the_first_ask() -> None:
    cohort = cohort_of(1, 2)
    cohort.ask()
    with pytest.raises(RuntimeError, match="after ask"):
        cohort.check_seeds(1)
    cohort.tell(np.zeros(2))
    cohort.succeed({1: genome(1), 3: genome(3)})
    with pytest.raises(RuntimeError, match="after ask"):
        cohort.check_seeds(1)
