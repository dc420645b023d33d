"""Tests of decoding: every meeting gets its design, and equal parts are decoded further only once."""

from __future__ import annotations

from typing import Any

import attrs
import numpy as np
from hypothesis import given, strategies as st

from evoframe import Design, Member, Network
from evoframe.evolution.decoding import decoded_designs
from evoframe.evolution.population import Population


@attrs.define
class Sum:
    """An encoder that adds its network's number to the last one of the design, and counts its calls."""

    role: str
    calls: int = 0

    @property
    def provides(self) -> tuple[str, ...]:
        return (self.role,)

    def decode(self, network: Network, design: Design) -> Design:
        self.calls += 1
        *_, before = 0.0, *numbers_of(design)
        return design.with_role(self.role, before + network(np.ones((1, 1)))[0])


class Numbers:
    """An evolver's run, whose genomes are numbers."""

    def express(self, genome: float) -> Network:
        return lambda points: points * genome


def population(name: str, genomes: list[int]) -> Population:
    encoder: Any = Sum(name)
    evolver: Any = Numbers()
    members = tuple(Member(number, None) for number in genomes)
    return Population(name, encoder, evolver, np.random.default_rng(0), genomes=genomes, members=members)


def calls(populated: Population) -> int:
    assert isinstance(populated.encoder, Sum)
    return populated.encoder.calls


def numbers_of(design: Design) -> list[float]:
    return [float(array[0]) for array in design.roles.values()]


few = st.lists(st.integers(0, 2), min_size=1, max_size=4)


@given(st.lists(few, min_size=2, max_size=3), st.data())
def test_each_meeting_gets_the_design_of_its_members(genomes: list[list[int]], data: st.DataObject) -> None:
    populations = [population(name, numbers) for name, numbers in zip("abc", genomes, strict=False)]
    positions = st.tuples(*(st.integers(0, len(numbers) - 1) for numbers in genomes))
    meetings = data.draw(st.lists(positions, max_size=8))
    designs = list(decoded_designs(populations, meetings))
    assert [numbers_of(design) for design in designs] == [
        np.cumsum([numbers[i] for numbers, i in zip(genomes, meeting, strict=True)]).tolist()
        for meeting in meetings
    ]


def test_equal_bodies_are_paired_with_a_controller_only_once() -> None:
    bodies, controllers = population("a", [5, 7, 5]), population("b", [1, 2])
    meetings = [(i, j) for i in range(3) for j in range(2)]
    designs = list(decoded_designs([bodies, controllers], meetings))
    assert designs[4:] == designs[:2]  # the same objects
    assert (calls(bodies), calls(controllers)) == (3, 4)


def test_equal_parts_of_different_populations_are_not_confused() -> None:
    first, second, third = population("a", [0]), population("b", [0]), population("c", [1, 2])
    designs = decoded_designs([first, second, third], [(0, 0, 0), (0, 0, 1)])
    assert [numbers_of(design) for design in designs] == [[0.0, 0.0, 1.0], [0.0, 0.0, 2.0]]


def test_designs_are_decoded_one_by_one() -> None:
    bodies, controllers = population("a", [5, 7]), population("b", [1])
    designs = decoded_designs([bodies, controllers], [(0, 0), (1, 0)])
    next(designs)
    assert calls(bodies) == 1
