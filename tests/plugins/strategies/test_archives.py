import json
from typing import Any

import attrs
import numpy as np
import pytest
from collaborators import SEEDS, chosen, genome, members_of, new_run, population, rows, turn
from hypothesis import given, strategies as st

from evoframe import Archived, Member
from evoframe_strategies import Fittest, HallOfFame, Previous


def generations(n: int) -> list[list[Member]]:
    """Return generations of four members; the champion of generation g has the id 10 g + 2."""
    return [
        [Member(10 * g + i, fitness, age=0) for i, fitness in enumerate((0.2, 0.5, 0.9, 0.5))]
        for g in range(n)
    ]


def after(strategy: Any, *seen: list[Member]) -> Any:
    """Return a run that has observed these generations."""
    run = new_run(strategy)
    for index, members in enumerate(seen):
        turn(run, members, index=index)
    return run


class TestHallOfFame:
    def test_contains_the_champions_of_earlier_generations(self) -> None:
        *earlier, now = generations(4)
        run = after(HallOfFame(n=3), *earlier)
        assert {frozenset(rows(run, now, seed=seed)[0]) for seed in range(9)} == {
            frozenset(["2", "12", "22"])
        }

    def test_draws_all_champions_equally_often(self) -> None:
        *earlier, now = generations(5)
        run = after(HallOfFame(n=1), *earlier)
        drawn = [rows(run, now, seed=seed)[0][0] for seed in range(2000)]
        # 500 expected each; the bound is five standard deviations.
        assert all(
            abs(drawn.count(one) - 500) < 5 * (2000 * 0.25 * 0.75) ** 0.5 for one in ("2", "12", "22", "32")
        )

    def test_gives_everybody_in_a_turn_the_same_champions(self) -> None:
        run = after(HallOfFame(n=2), *generations(6))
        assert len({tuple(row) for row in rows(run, generations(7)[-1], n=5)}) == 1

    def test_is_completed_by_the_fittest_members(self) -> None:
        first, now = generations(2)
        assert rows(after(HallOfFame(n=3), first), now) == [["2", 12, 11]]

    @given(members_of(), SEEDS, st.data())
    def test_is_the_fittest_members_before_there_is_a_champion(
        self, members: list[Member], seed: int, data: st.DataObject
    ) -> None:
        n = data.draw(st.integers(1, len(members)))
        assert chosen(HallOfFame(n=n), members, seed) == chosen(Fittest(n=n), members)

    def test_keeps_the_latest(self) -> None:
        *earlier, now = generations(6)
        run = after(HallOfFame(n=2, capacity=2), *earlier)
        assert set(rows(run, now)[0]) == {"32", "42"}

    def test_keeps_a_champion_of_several_generations_once_and_as_the_latest(self) -> None:
        first, second, now = generations(3)
        returned = [attrs.evolve(first[2], age=2), *second[1:]]
        run = after(HallOfFame(n=2, capacity=3), first, second, returned)
        assert [one["member"]["id"] for one in run.state()["champions"]] == [12, 2]
        assert set(rows(run, now)[0]) == {"2", "12"}

    def test_chooses_a_champion_that_is_still_a_member_by_its_index(self) -> None:
        [members] = generations(1)
        assert rows(after(HallOfFame(n=1), members), members) == [[2]]

    def test_does_not_contain_diverged_individuals(self) -> None:
        first, second = population(0.9, 0.5, diverged=(0,)), population(0.9, diverged=(0,), first_id=50)
        run = after(HallOfFame(n=1), first, second)
        assert [one["member"]["id"] for one in run.state()["champions"]] == [99]

    def test_remembers_genomes(self) -> None:
        first, now = generations(2)
        [[choice]] = after(HallOfFame(n=1), first).choose([None], now, new_generator())
        assert isinstance(choice, Archived)
        assert choice.genome == genome(2)
        assert choice.member == first[2]

    @pytest.mark.parametrize(
        "state", [None, {}, {"champions": None}, {"champions": [{"member": {"id": 1}, "genome": 1}]}]
    )
    def test_refuses_an_invalid_state(self, state: Any) -> None:
        with pytest.raises(ValueError, match="state"):
            new_run(HallOfFame()).restore(state)

    def test_refuses_a_state_with_an_individual_twice(self) -> None:
        state = after(HallOfFame(), *generations(1)).state()
        with pytest.raises(ValueError, match=r"\[2\]"):
            new_run(HallOfFame()).restore({"champions": state["champions"] * 2})


def new_generator() -> Any:
    return np.random.default_rng(0)


class TestPrevious:
    def test_is_the_fittest_of_the_generation_before(self) -> None:
        first, second, now = generations(3)
        assert rows(after(Previous(n=3), first, second), second) == [["2", "1", "3"]]
        assert rows(after(Previous(n=2), first, second, now), now) == [["12", "11"]]

    def test_is_the_fittest_members_in_the_first_generation(self) -> None:
        [members] = generations(1)
        assert rows(after(Previous(n=3), members), members) == [[2, 1, 3]]

    def test_does_not_change_while_another_population_is_evaluated(self) -> None:
        first, second = generations(2)
        run = after(Previous(n=1), first, second, second, second)
        assert rows(run, second) == [["2"]]

    def test_changes_if_all_members_survive_a_generation(self) -> None:
        [first] = generations(1)
        older = [attrs.evolve(member, age=1, fitness=-(member.fitness or 0.0)) for member in first]
        assert rows(after(Previous(n=1), first, older), older) == [[2]]  # the fittest in `first`

    def test_is_a_single_choice_of_the_fittest_members(self) -> None:
        assert chosen(Previous(n=2), population(0.1, 0.3, 0.2)) == [1, 2]

    def test_has_the_fitness_of_that_generation(self) -> None:
        first, second = generations(2)
        [[choice]] = after(Previous(n=1), first, second).choose([None], second, new_generator())
        assert (choice.member, choice.genome) == (first[2], genome(2))

    def test_is_completed_by_current_members_if_others_diverged(self) -> None:
        first, second = population(0.9, 0.5, 0.1, diverged=(0, 1)), population(0.3, 0.4, 0.2, first_id=50)
        assert rows(after(Previous(n=2), first, second), second) == [["98", 49]]

    def test_continues_from_its_state(self) -> None:
        first, second, now = generations(3)
        run = new_run(Previous())
        run.restore(json.loads(json.dumps(after(Previous(), first, second).state())))
        turn(run, now)
        assert rows(run, now) == [["12", "11"]]
