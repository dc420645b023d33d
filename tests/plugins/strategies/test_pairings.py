from collections import Counter

import numpy as np
import pytest
from collaborators import SEEDS, chosen, judged, members_of, population
from hypothesis import given, strategies as st

from evoframe import Judged, Member
from evoframe_strategies import All, Neighbourhood, Shuffled

SHAPES = ("ring", "torus")


def shuffled(n: int, n_judged: int, members: list[Member], seed: int = 0) -> list[list[int]]:
    rng = np.random.default_rng(seed)
    rows: list[list[int]] = Shuffled(n=n).select_each(judged(n_judged), members, rng).tolist()
    return rows


def nearest(strategy: Neighbourhood, members: list[Member], *cells: int) -> list[list[int]]:
    individuals = [Judged(Member(0, None), index=cell) for cell in cells]
    rows: list[list[int]] = strategy.select_each(individuals, members, np.random.default_rng(0)).tolist()
    return rows


def shares(rows: list[list[int]], among: list[int]) -> set[int]:
    counts = Counter(index for row in rows for index in row)
    return {counts[index] for index in among}


@given(members_of(clean=True), st.integers(0, 15), SEEDS, st.data())
def test_all_members_take_part_equally_often(
    members: list[Member], n_judged: int, seed: int, data: st.DataObject
) -> None:
    n = data.draw(st.integers(1, len(members)))
    rows = shuffled(n, n_judged, members, seed)
    counts = shares(rows, [*range(len(members))])
    assert max(counts) - min(counts) <= 1
    assert all(len(set(row)) == n for row in rows)


@given(members_of(), st.integers(1, 15), SEEDS, st.data())
def test_clean_and_diverged_members_each_take_part_equally_often(
    members: list[Member], n_judged: int, seed: int, data: st.DataObject
) -> None:
    n = data.draw(st.integers(1, len(members)))
    rows = shuffled(n, n_judged, members, seed)
    for state in (False, True):
        of_state = [index for index, member in enumerate(members) if member.diverged is state]
        counts = shares(rows, of_state) or {0}
        assert max(counts) - min(counts) <= 1
        assert state or n < len(of_state) or counts == {n_judged} or not of_state


def test_pairings_are_random() -> None:
    members = population(*range(10))
    firsts = Counter(shuffled(1, 10, members, seed)[0][0] for seed in range(2000))
    # 200 expected each; the bound is five standard deviations.
    assert all(abs(firsts[index] - 200) < 5 * (2000 * 0.1 * 0.9) ** 0.5 for index in range(10))
    assert shuffled(3, 10, members, 1) != shuffled(3, 10, members, 2)


def test_shuffled_needs_no_fitness() -> None:
    assert sorted(chosen(Shuffled(n=3), population(None, None, None))) == [0, 1, 2]


def test_individuals_on_a_ring_meet_the_members_beside_them() -> None:
    ring = Neighbourhood(n=4)
    assert nearest(ring, population(*[0.0] * 8), 0, 3, 7) == [[0, 1, 7, 2], [3, 4, 2, 5], [7, 0, 6, 1]]


def test_individuals_on_a_torus_meet_the_members_above_and_beside_them() -> None:
    torus = Neighbourhood(n=5, shape="torus")
    [middle, corner] = nearest(torus, population(*[0.0] * 25), 12, 0)
    assert middle[0] == 12
    assert set(middle) == {12, 11, 13, 7, 17}
    assert set(corner) == {0, 1, 4, 5, 20}


@pytest.mark.parametrize(("size", "columns"), [(25, 5), (24, 6), (16, 4), (12, 4)])
def test_a_torus_is_as_square_as_possible(size: int, columns: int) -> None:
    [row] = nearest(Neighbourhood(n=5, shape="torus"), population(*[0.0] * size), 0)
    assert set(row) == {0, 1, columns - 1, columns, size - columns}


def test_a_torus_of_a_prime_number_of_members_is_a_ring() -> None:
    members = population(*range(23))
    shapes = [nearest(Neighbourhood(n=9, shape=shape), members, 7) for shape in SHAPES]
    assert shapes[0] == shapes[1]


def distances(cell: int, rows: int, columns: int) -> dict[int, int]:
    """Return the steps to all cells of a torus, found by walking."""
    steps, edge = {cell: 0}, [cell]
    for here in edge:
        row, column = divmod(here, columns)
        beside = [(row + 1, column), (row - 1, column), (row, column + 1), (row, column - 1)]
        for there in ((r % rows) * columns + c % columns for r, c in beside):
            if there not in steps:
                steps[there] = steps[here] + 1
                edge.append(there)
    return steps


ROWS = {1: 1, 2: 1, 3: 1, 4: 2, 5: 1, 6: 2, 7: 1, 8: 2, 9: 3, 10: 2, 11: 1, 12: 3}


@given(members_of(), st.integers(0, 40), st.sampled_from(SHAPES))
def test_nobody_nearer_is_left(members: list[Member], index: int, shape: str) -> None:
    size = len(members)
    rows = ROWS[size] if shape == "torus" else 1
    steps = distances(index % size, rows, size // rows)
    [row] = nearest(Neighbourhood(n=size, shape=shape), members, index)
    ranks = [(members[i].diverged, steps[i]) for i in row]
    assert ranks == sorted(ranks)
    assert sorted(row) == chosen(All(), members)


@given(members_of(clean=True), st.sampled_from(SHAPES), st.data())
def test_all_members_of_a_population_of_the_same_size_take_part_equally_often(
    members: list[Member], shape: str, data: st.DataObject
) -> None:
    n = data.draw(st.integers(1, len(members)))
    strategy = Neighbourhood(n=n, shape=shape)
    everybody = [*range(len(members))]
    assert shares(nearest(strategy, members, *everybody), everybody) == {n}


def test_cells_are_those_of_the_index_and_not_of_the_place_in_a_call() -> None:
    members = population(*range(6))
    ring = Neighbourhood(n=2)
    assert nearest(ring, members, 4, 1) == nearest(ring, members, 4) + nearest(ring, members, 1)


def test_a_single_choice_is_that_of_the_first_cell() -> None:
    assert chosen(Neighbourhood(n=3), population(*range(6))) == [0, 1, 5]


def test_larger_populations_go_around_again() -> None:
    assert nearest(Neighbourhood(n=1), population(*range(4)), 3, 4, 9) == [[3], [0], [1]]


def test_diverged_neighbors_are_a_last_resort() -> None:
    members = population(*range(6), diverged=(2, 3))
    assert nearest(Neighbourhood(n=5), members, 2) == [[1, 4, 0, 5, 2]]


def test_an_unknown_shape_is_refused() -> None:
    with pytest.raises(ValueError, match="'shape' must be in"):
        Neighbourhood(shape="cube")
