import re
from typing import Any

import numpy as np
import pytest
from collaborators import SEEDS, chosen, judged, members_of, new_run, parts, population, rows, turn
from hypothesis import given, strategies as st

from evoframe import Archived, Choice, ConfigurationError, Judged, Member, load_config, sizes_of
from evoframe_strategies import (
    All,
    BestAndRandom,
    BestAndWorst,
    Fittest,
    HallOfFame,
    Neighbourhood,
    Previous,
    Random,
    Rank,
    Roulette,
    Shuffled,
    SpeciesChampions,
    Sum,
    Tournament,
    Worst,
)


def sum_of(*components: Any) -> Sum:
    return Sum(parts(*components))


@given(members_of(least=2), st.data())
def test_fittest_and_worst_are_best_and_worst(members: list[Member], data: st.DataObject) -> None:
    n = data.draw(st.integers(1, len(members) // 2))
    assert chosen(sum_of(Fittest(n=n), Worst(n=n)), members) == chosen(BestAndWorst(n=n), members)


@given(members_of(), SEEDS, st.data())
def test_fittest_and_random_are_best_and_random(
    members: list[Member], seed: int, data: st.DataObject
) -> None:
    n = data.draw(st.integers(1, len(members)))
    both = [Fittest(n=1), *([Random(n=n - 1)] if n > 1 else [])]
    assert chosen(sum_of(*both), members, seed) == chosen(BestAndRandom(n=n), members, seed)


@given(members_of(least=2), st.data())
def test_parts_of_the_fittest_are_the_fittest(members: list[Member], data: st.DataObject) -> None:
    cut = data.draw(st.integers(1, len(members) - 1))
    halves = sum_of(Fittest(n=cut), Fittest(n=len(members) - cut))
    assert chosen(halves, members) == chosen(Fittest(n=len(members)), members)


ONE = [
    Fittest,
    Worst,
    Random,
    Roulette,
    Rank,
    Tournament,
    SpeciesChampions,
    Shuffled,
    Neighbourhood,
    HallOfFame,
]


@given(members_of(least=2), st.integers(0, 5), SEEDS, st.sampled_from(ONE))
def test_a_sum_of_one_part_equals_it(members: list[Member], n: int, seed: int, class_: Any) -> None:
    alone, within = new_run(class_(n=2)), new_run(sum_of(class_(n=2)))
    for run in (alone, within):
        turn(run, population(0.5, 0.1))
    assert rows(alone, members, n, seed) == rows(within, members, n, seed)


def test_a_sum_of_everybody_is_everybody() -> None:
    members = population(*range(6))
    assert sorted(chosen(sum_of(Random(n=2), All()), members)) == [0, 1, 2, 3, 4, 5]


def after(strategy: Any, *champions: int) -> Any:
    """Return a run that has observed generations with these champions."""
    run = new_run(strategy)
    for id_ in champions:
        turn(run, [Member(id_, 0.5), Member(1000 + id_, 0.1)])
    return run


def test_fittest_random_and_archived_individuals_are_added() -> None:
    run = after(sum_of(Fittest(n=2), Random(n=1), HallOfFame(n=1)), 7)
    members = population(*range(6))
    for seed in range(9):
        [[first, second, drawn, champion]] = rows(run, members, seed=seed)
        assert (first, second, champion) == (95, 96, "7")
        assert drawn in {97, 98, 99, 100}


def test_a_champion_that_is_chosen_already_is_replaced_by_the_fittest_left() -> None:
    run = after(sum_of(Fittest(n=2), HallOfFame(n=1)), 97)
    assert rows(run, population(0.1, 0.3, 0.2, 0.9)) == [[97, 99, 98]]  # the champion 97 is the fittest


def test_an_archived_individual_is_not_added_twice() -> None:
    run = after(sum_of(HallOfFame(n=1), HallOfFame(n=1)), 7)
    assert rows(run, population(0.1, 0.3, 0.2)) == [["7", 99]]


def test_parts_choose_among_the_members_that_are_left() -> None:
    run = after(sum_of(HallOfFame(n=1), Worst(n=2), Fittest(n=1)), 7)
    assert rows(run, population(0.1, 0.3, 0.2, 0.4)) == [["7", 100, 98, 97]]


class Counting:
    """A run that notes whom it was asked for."""

    def __init__(self) -> None:
        self.asked: list[list[int]] = []

    def choose(self, judged: list[Judged], members: list[Member], rng: Any) -> list[list[Choice]]:
        self.asked.append([one.index for one in judged])
        return [[0]] * len(judged)


def test_a_part_is_asked_once_for_all_with_the_same_collaborators() -> None:
    counting = Counting()
    run = new_run(sum_of(Neighbourhood(n=1), Fittest(n=1)))
    run._runs[1] = counting
    made = run.choose(judged(6), population(0.1, 0.2, 0.3), np.random.default_rng(0))
    assert counting.asked == [[0, 3], [1, 4], [2, 5]]
    assert made == [[0, 1], [1, 0], [2, 0], [0, 1], [1, 0], [2, 0]]


def test_different_orders_of_the_same_collaborators_are_asked_for_together() -> None:
    counting = Counting()
    run = new_run(sum_of(Shuffled(n=3), Fittest(n=1)))
    run._runs[1] = counting
    run.choose(judged(6), population(0.1, 0.2, 0.3, 0.4, diverged=(3,)), np.random.default_rng(0))
    assert counting.asked == [[0, 1, 2, 3, 4, 5]]


def test_nobody_to_judge_gives_no_rows() -> None:
    assert rows(new_run(Sum()), population(0.1, 0.2, 0.3), n=0) == []


def test_the_numbers_depend_on_what_archives_leave() -> None:
    everybody = sum_of(HallOfFame(n=2), All())
    assert everybody.size(5) == 5
    assert sizes_of(everybody, 5) == (5, 6, 7)
    run = after(everybody, 7)
    assert len(rows(run, population(*range(5)))[0]) == 6
    assert sizes_of(sum_of(HallOfFame(n=2), Fittest(n=2)), 5) == (4,)


def test_a_part_that_finds_too_few_members_is_named() -> None:
    strategy = sum_of(Fittest(n=3), Random(n=2), Worst(n=2))
    assert strategy.size(7) == 7
    for refuse in (strategy.size, strategy.sizes):
        with pytest.raises(ConfigurationError) as refused:
            refuse(6)
        assert re.findall(r"\d+", refused.value.problem) == ["2", "1", "6"]  # parts[2], 1 of 6 left
        assert "'worst'" in refused.value.problem


def test_a_sum_has_parts() -> None:
    with pytest.raises(ValueError, match="parts"):
        Sum(())


@pytest.mark.parametrize("state", [None, {}, {"parts": []}, {"parts": [None, None, None]}])
def test_an_invalid_state_is_refused(state: Any) -> None:
    with pytest.raises(ValueError, match="state"):
        new_run(Sum()).restore(state)


def test_the_state_holds_those_of_the_parts() -> None:
    strategy = sum_of(HallOfFame(n=1), Previous(n=1))
    run, again = after(strategy, 7, 8, 9), new_run(strategy)
    again.restore(run.state())
    members = population(0.1, 0.2)
    for seed in range(5):
        assert rows(again, members, seed=seed) == rows(run, members, seed=seed)
    [[first, second]] = run.choose(judged(1), members, np.random.default_rng(0))
    assert isinstance(first, Archived)
    assert isinstance(second, Archived | int)


def test_a_sum_is_read_from_a_configuration() -> None:
    table = '{name="sum", parts=[{name="fittest", n=2}, {name="random", n=1}, {name="hall-of-fame", n=1}]}'
    config = load_config("paper", overrides=[f"collaboration={table}", "aggregator=am"])
    assert config.collaboration.component == sum_of(Fittest(n=2), Random(n=1), HallOfFame(n=1))
    keys = [key for key, _ in config.collaboration.nested("collaboration")]
    assert keys == ["collaboration", *(f"collaboration.parts[{index}]" for index in range(3))]


@pytest.mark.parametrize(
    ("table", "key"),
    [
        ('{name="sum", parts=["fittest", {name="random", n=0}]}', "collaboration.parts[1].n"),
        ('{name="sum", parts=["nobody"]}', "collaboration.parts[0]"),
        ('{name="sum", parts=[]}', "collaboration.parts"),
        ('{name="sum", parts=[{name="random", n=20}, {name="fittest", n=20}]}', "collaboration"),
    ],
)
def test_faults_name_their_key(table: str, key: str) -> None:
    with pytest.raises(ConfigurationError) as refused:
        load_config("paper", overrides=[f"collaboration={table}", "aggregator=am"])
    assert refused.value.key == key
