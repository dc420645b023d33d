import itertools
import math
from typing import Any

import numpy as np
import pytest
from collaborators import SEEDS, chosen, genome, new_run, population, rows, turn
from hypothesis import given, strategies as st

from evoframe import Archived, Member
from evoframe_strategies import Fittest, Informative
from evoframe_strategies.informative import informative_rows

SCORES = st.sampled_from([-math.inf, -1.0, 0.0, 1.0, 2.0]) | st.integers(-5, 5).map(float)
MATRICES = st.tuples(st.integers(1, 6), st.integers(1, 6)).flatmap(
    lambda shape: st.lists(
        st.lists(SCORES, min_size=shape[1], max_size=shape[1]), min_size=shape[0], max_size=shape[0]
    )
)


def by_definition(payoff: list[list[float]], limit: int) -> list[int]:
    """Return the archive as the rule reads, with loops over collaborators and pairs of individuals."""
    columns = range(len(payoff[0]))
    archive: list[int] = []

    def best(individual: int, collaborators: list[int]) -> float:
        return max((payoff[c][individual] for c in collaborators), default=-math.inf)

    def gain(row: int) -> float:
        """Return the highest score by which a collaborator lifts an individual above another one."""
        gains = [
            payoff[row][p]
            for p, q in itertools.permutations(columns, 2)
            if best(p, archive) <= best(q, archive) and best(p, [*archive, row]) > best(q, [*archive, row])
        ]
        return max(gains, default=-math.inf)

    while len(archive) < limit:
        gains = [gain(row) if archive else max(payoff[row]) for row in range(len(payoff))]
        if max(gains) == -math.inf:
            break
        archive.append(gains.index(max(gains)))
    return archive


@given(MATRICES, st.integers(0, 7))
def test_the_archive_follows_its_rule(payoff: list[list[float]], limit: int) -> None:
    assert informative_rows(np.array(payoff), limit) == by_definition(payoff, limit)


@given(MATRICES)
def test_the_archive_preserves_the_order_of_individuals(payoff: list[list[float]]) -> None:
    matrix = np.array(payoff)
    archive = informative_rows(matrix, len(matrix))
    assert len(set(archive)) == len(archive)
    complete = matrix.max(axis=0)
    kept = matrix[archive].max(axis=0) if archive else np.full(len(complete), -math.inf)
    for p, q in itertools.permutations(range(len(complete)), 2):
        assert not complete[p] < complete[q] or kept[p] < kept[q]


@given(MATRICES, st.integers(0, 6))
def test_a_smaller_archive_begins_a_larger_one(payoff: list[list[float]], limit: int) -> None:
    matrix = np.array(payoff)
    assert informative_rows(matrix, limit) == informative_rows(matrix, 6)[:limit]


def test_one_collaborator_is_enough_if_it_shows_the_whole_order() -> None:
    assert informative_rows(np.array([[3.0, 2.0, 1.0], [2.9, 1.9, 0.9], [0.0, 0.0, 0.0]]), 3) == [0]


def test_a_collaborator_that_shows_a_hidden_strength_is_kept() -> None:
    # With collaborator 0, individual 2 looks worst; only collaborator 2 shows that it is second.
    payoff = [[3.0, 1.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 2.0]]
    assert informative_rows(np.array(payoff), 3) == [0, 2]


def archive_of(run: Any) -> list[int]:
    return [one["member"]["id"] for one in run.state()["archive"]]


def test_the_most_informative_come_first_then_the_fittest_then_others() -> None:
    others = population(0.1, 0.2, 0.3, 0.4)  # with the ids 100, 99, 98, 97
    run = new_run(Informative(n=4))
    turn(run, others, [[3.0, 1.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 2.0], [0.0, 0.0, 0.0]])
    assert archive_of(run) == [100, 98]
    assert rows(run, others) == [[100, 98, 97, 99]]


def test_others_are_drawn_at_random() -> None:
    others = population(*range(10))
    run = new_run(Informative(n=3))
    last = {rows(run, others, seed=seed)[0][-1] for seed in range(200)}
    assert last == set(range(92, 101))  # all but the fittest, which comes first


def test_the_archive_leaves_a_place_for_the_fittest() -> None:
    others = population(0.1, 0.2, 0.9)
    run = new_run(Informative(n=2))
    turn(run, others, [[3.0, 1.0, 0.0], [0.0, 0.0, 2.0], [0.0, 0.0, 0.0]])
    assert archive_of(run) == [100]
    assert rows(run, others) == [[100, 98]]


def test_an_archive_of_more_individuals_is_shortened() -> None:
    others = population(0.1, 0.2, 0.9)
    larger, run = new_run(Informative(n=4)), new_run(Informative(n=2))
    turn(larger, others, [[3.0, 1.0, 0.0], [0.0, 0.0, 2.0], [0.0, 0.0, 0.0]])
    assert archive_of(larger) == [100, 99]
    run.restore(larger.state())
    assert rows(run, others) == [[100, 98]]


@given(st.lists(st.integers(-3, 3).map(float), min_size=1, max_size=8), SEEDS)
def test_one_collaborator_is_the_fittest(fitness: list[float], seed: int) -> None:
    members = population(*fitness)
    assert chosen(Informative(n=1), members, seed) == chosen(Fittest(n=1), members)


def test_only_individuals_that_met_the_whole_population_are_compared() -> None:
    others = population(0.1, 0.2, 0.9)
    run = new_run(Informative(n=3))
    turn(run, others, [[9.0, None, 9.0], [0.0, 1.0, 0.0], [None, None, 5.0]])
    assert archive_of(run) == [99]


def test_a_turn_of_the_other_population_changes_nothing() -> None:
    first, later = population(0.1, 0.2), population(0.3, 0.4, first_id=50)
    run = new_run(Informative())
    turn(run, first, [[3.0, 1.0], [0.0, 0.0]])
    turn(run, later, [[5.0, None], [6.0, None]])
    assert archive_of(run) == [100]


def test_an_archived_individual_stays_while_it_is_informative() -> None:
    first, later = population(0.1, 0.2), population(0.3, 0.4, first_id=50)
    run = new_run(Informative(n=2))
    turn(run, first, [[3.0, 1.0], [0.0, 0.0]])
    [[choice, _]] = run.choose([None], later, np.random.default_rng(0))
    assert isinstance(choice, Archived)
    assert choice.genome == genome(100)
    archived: list[Member] = [choice.member]
    turn(run, later, [[1.0, 2.0], [None, None], [4.0, 0.0]], archived=archived)
    assert archive_of(run) == [100]
    turn(run, later, [[5.0, 2.0], [None, None], [4.0, 0.0]], archived=archived)
    assert archive_of(run) == [50]


def test_a_diverged_simulation_is_the_lowest_score() -> None:
    others = population(0.1, 0.2)
    run = new_run(Informative(n=3))
    turn(run, others, [[math.nan, -5.0], [math.nan, math.nan]])
    assert archive_of(run) == [100]


def test_diverged_individuals_are_not_archived() -> None:
    run = new_run(Informative(n=3))
    turn(run, population(0.1, 0.2, diverged=(0,)), [[9.0, 0.0], [1.0, 0.0]])
    assert archive_of(run) == [99]


def test_an_archive_with_an_individual_twice_is_refused() -> None:
    run = new_run(Informative(n=3))
    turn(run, population(0.1, 0.2), [[3.0, 1.0], [0.0, 0.0]])
    with pytest.raises(ValueError, match=r"\[100\]"):
        run.restore({"archive": run.state()["archive"] * 2})
