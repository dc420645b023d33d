import re
from typing import Any

import numpy as np
import pytest
from collaborators import SEEDS, chosen, judged, members_of, new_run, parts, population, rows, turn
from hypothesis import given, strategies as st

from evoframe import ConfigurationError, Member, load_config
from evoframe_strategies import (
    All,
    BestAndWorst,
    Fittest,
    HallOfFame,
    Informative,
    Random,
    Scheduled,
    Shuffled,
    Sum,
    Tournament,
)

MEMBERS = population(*range(8))


def scheduled(component: Any, *stages: tuple[int, int]) -> Scheduled:
    """Return a schedule whose stages are pairs: turns before, and n."""
    [strategy] = parts(component)
    return Scheduled(strategy, n=tuple(n for _, n in stages), since=tuple(since for since, _ in stages))


def counts(run: Any, turns: int) -> list[int]:
    """Return the numbers of collaborators in these turns."""
    found = []
    for index in range(turns):
        found.append(len(rows(run, MEMBERS)[0]))
        turn(run, MEMBERS, index=index)
    return found


@given(
    members_of(least=3),
    SEEDS,
    st.sampled_from([Fittest, Random, Tournament, Shuffled, HallOfFame, Informative]),
)
def test_a_constant_schedule_equals_its_strategy(members: list[Member], seed: int, class_: Any) -> None:
    alone, within = new_run(class_(n=3)), new_run(scheduled(class_(), (0, 3), (2, 3)))
    for index in range(4):
        assert rows(alone, members, n=4, seed=seed + index) == rows(within, members, n=4, seed=seed + index)
        for run in (alone, within):
            turn(run, members, [[float(seed % (i + 2)), 1.0] for i in range(len(members))], index=index)


def test_stages_begin_after_as_many_turns() -> None:
    assert counts(new_run(scheduled(Fittest(), (0, 5), (3, 2), (4, 1))), 6) == [5, 5, 5, 2, 1, 1]


def test_a_single_choice_is_that_of_the_first_turn() -> None:
    assert chosen(scheduled(Fittest(), (0, 3), (1, 2)), MEMBERS) == [7, 6, 5]


def test_numbers_of_collaborators_are_those_of_the_strategy() -> None:
    assert counts(new_run(scheduled(BestAndWorst(), (0, 3), (1, 1))), 2) == [6, 2]


def test_turns_without_a_choice_do_not_count() -> None:
    run = new_run(scheduled(Random(), (0, 3), (1, 2)))
    for index in range(5):
        turn(run, MEMBERS, index=index)
    assert counts(run, 2) == [3, 2]


def test_turns_of_the_other_population_do_not_count() -> None:
    run = new_run(scheduled(Random(), (0, 3), (2, 2)))
    found = []
    for index in range(3):
        found.append(len(rows(run, MEMBERS)[0]))
        turn(run, MEMBERS, index=2 * index)
        turn(run, MEMBERS, index=2 * index + 1)
    assert found == [3, 3, 2]


def test_several_choices_in_a_turn_are_one_turn() -> None:
    run = new_run(scheduled(Random(), (0, 3), (1, 2)))
    for first in (0, 2):
        assert len(run.choose(judged(2, first), MEMBERS, np.random.default_rng(0))[0]) == 3
    assert counts(run, 2) == [3, 2]


def test_the_state_holds_the_number_of_turns() -> None:
    schedule = scheduled(Fittest(), (0, 3), (2, 1))
    run, again = new_run(schedule), new_run(schedule)
    rows(run, MEMBERS)
    again.restore(run.state())  # within a turn
    turn(again, MEMBERS)
    assert counts(again, 2) == [3, 1]


def test_later_stages_remember_earlier_turns() -> None:
    run = new_run(scheduled(HallOfFame(), (0, 1), (1, 2)))
    first, second = population(0.5, first_id=10), population(0.5, first_id=20)
    rows(run, first)
    turn(run, first)
    turn(run, second)
    now = population(0.4, 0.3)
    assert set(rows(run, now)[0]) == {"10", "20"}


@pytest.mark.parametrize(
    "state",
    [
        None,
        {"turns": -1, "has_chosen": False, "stages": [None, None]},
        {"turns": 0, "has_chosen": False, "stages": [None]},
        {"turns": 0, "has_chosen": False, "stages": [None, 5]},
    ],
)
def test_an_invalid_state_is_refused(state: Any) -> None:
    run = new_run(scheduled(Fittest(), (0, 3), (2, 1)))
    with pytest.raises(ValueError, match="state"):
        run.restore(state)


def test_all_numbers_are_declared() -> None:
    schedule = scheduled(BestAndWorst(), (0, 3), (2, 1), (5, 3))
    assert schedule.size(8) == 6
    assert set(schedule.sizes(8)) == {6, 2}


def test_a_population_too_small_for_any_stage_is_refused() -> None:
    schedule = scheduled(Fittest(), (0, 2), (5, 9))
    assert set(schedule.sizes(9)) == {2, 9}
    for refuse in (schedule.size, schedule.sizes):
        with pytest.raises(ConfigurationError) as refused:
            refuse(8)
        assert re.findall(r"\d+", refused.value.problem) == ["9", "8"]


@pytest.mark.parametrize(
    ("options", "found"),
    [
        ({"n": (5, 2), "since": (0,)}, r"\[5, 2\].*\[0\]"),
        ({"n": (5, 2), "since": (1, 2)}, r"\[1, 2\]"),
        ({"n": (5, 2), "since": (0, 0)}, r"\[0, 0\]"),
        ({"n": (), "since": ()}, r"\[\]"),
        ({"n": (5, 0)}, "0"),
        ({"strategy": parts(All())[0]}, "'all'"),
        ({"strategy": parts(Sum())[0]}, "'sum'"),
        ({"strategy": parts(Scheduled())[0]}, "'scheduled'"),
    ],
)
def test_invalid_schedules_are_refused(options: Any, found: str) -> None:
    with pytest.raises(ValueError, match=found):
        Scheduled(**options)


def test_a_schedule_is_read_from_a_configuration() -> None:
    table = (
        '{name="scheduled", strategy={name="tournament", tournament_size=4}, n=[5, 2, 1], since=[0, 50, 150]}'
    )
    config = load_config("paper", overrides=[f"collaboration={table}", "aggregator=am"])
    expected = scheduled(Tournament(tournament_size=4), (0, 5), (50, 2), (150, 1))
    assert config.collaboration.component == expected


@pytest.mark.parametrize(
    ("table", "key"),
    [
        ('{name="scheduled", strategy="nobody"}', "collaboration.strategy"),
        ('{name="scheduled", strategy="all"}', "collaboration.strategy"),
        ('{name="scheduled", since=[1, 2]}', "collaboration.since"),
        ('{name="scheduled", n=[1, 0]}', "collaboration.n"),
        ('{name="scheduled", n=[1]}', "collaboration"),
        ('{name="scheduled", n=[26, 2]}', "collaboration"),
    ],
)
def test_faults_name_their_key(table: str, key: str) -> None:
    with pytest.raises(ConfigurationError) as refused:
        load_config("paper", overrides=[f"collaboration={table}", "aggregator=am"])
    assert refused.value.key == key
