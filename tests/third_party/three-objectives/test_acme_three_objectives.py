"""Contract tests of ``domination``, and examples."""

import numpy as np
import pytest
from acme_three_objectives import Domination, dominators

from evoframe.testing import EvolverContract


class TestDomination(EvolverContract):
    component = Domination()


class TestFourObjectives(EvolverContract):
    component = Domination(minimize=("age", "genome-size", "novelty"), mutation_sd=2.0)
    inputs, outputs, size = 0, 1, 5


@pytest.mark.parametrize(
    ("objectives", "expected"),
    [
        ([[1.0, 2.0, 3.0]], [2, 1, 0]),
        ([[1.0, 2.0, 3.0], [3.0, 2.0, 1.0]], [0, 0, 0]),
        ([[1.0, 1.0, 2.0], [1.0, 1.0, 1.0], [0.0, 0.0, 0.0]], [1, 1, 0]),  # equals dominate neither
    ],
)
def test_a_member_is_dominated_by_what_is_nowhere_worse(
    objectives: list[list[float]], expected: list[int]
) -> None:
    assert dominators(np.array(objectives)).tolist() == expected


def test_members_that_nobody_dominates_survive() -> None:
    run = Domination().start(2, 1, 4, np.random.default_rng(1))
    ids = [genome.id for genome in run.ask()]
    fitness, contractile = np.array([1.0, 5.0, 5.0, 4.0]), np.array([0.0, 9.0, 8.0, 8.0])
    run.tell(fitness, {"age": np.zeros(4), "count-contractile": contractile})
    assert [genome.id for genome in run.ask()][:2] == [ids[0], ids[2]]
    assert [member.age for member in run.members()] == [1, 1, 0, 0]
