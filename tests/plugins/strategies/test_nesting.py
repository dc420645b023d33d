from typing import Any

import pytest
from collaborators import new_run, population, rows, turn

from evoframe import discover
from evoframe_strategies import Fittest, HallOfFame, Random
from evoframe_strategies.nesting import built_in, restored


def test_defaults_name_the_plugin_that_offers_them() -> None:
    offer = discover().find("strategy", "random")
    assert built_in("random", Random()).source == offer.source


def start() -> list[Any]:
    return [new_run(Fittest()), new_run(HallOfFame(n=1))]


def test_runs_continue_from_their_states() -> None:
    runs = start()
    turn(runs[1], population(0.5, 0.4))
    again = restored(start, [run.state() for run in runs])
    later = population(0.1, first_id=7)
    assert rows(again[1], later) == rows(runs[1], later) == [["100"]]


@pytest.mark.parametrize("states", [[], [None], [None] * 3])
def test_another_number_of_states_is_refused(states: list[Any]) -> None:
    with pytest.raises(ValueError, match=f"2 strategies, found {len(states)}"):
        restored(start, states)


def test_an_invalid_state_is_refused() -> None:
    with pytest.raises(ValueError, match="champions"):
        restored(start, [None, {"champions": 5}])
