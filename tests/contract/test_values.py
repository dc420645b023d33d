"""Tests of exchanged values: they cannot be changed."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import attrs
import numpy as np
import pytest
from hypothesis import given, strategies as st
from hypothesis.extra.numpy import array_shapes, arrays
from numpy.typing import NDArray

from evoframe import (
    ArrayType,
    Design,
    Member,
    Outcome,
    Pair,
    Record,
    RunConfig,
    Score,
    ScoredMeetings,
    Turn,
    Workload,
    assemble,
)
from evoframe.contract import values

numbers = arrays(st.sampled_from(["uint8", "float64"]), array_shapes(max_dims=3, max_side=3))


def test_a_design_in_a_cache_cannot_be_changed() -> None:
    array = np.array([1.0])
    given_design = Design({"a": array})
    array[0] = 2.0
    assert given_design.roles["a"][0] == 1.0
    with pytest.raises(ValueError, match="read-only"):
        given_design.roles["a"][0] = 3.0


@given(st.dictionaries(st.sampled_from("abc"), numbers), st.sampled_from("abcd"), numbers)
def test_adding_a_role_keeps_all_others(
    roles: dict[str, NDArray[Any]], role: str, array: NDArray[Any]
) -> None:
    design = Design(roles)
    wider = design.with_role(role, array)
    assert wider.roles.keys() == {*roles, role}
    for name, value in {**roles, role: array}.items():
        np.testing.assert_array_equal(wider.roles[name], value)
        assert wider.roles[name].dtype == value.dtype
    assert design.roles.keys() == roles.keys()


def test_a_read_only_array_is_not_copied() -> None:
    design = Design({"a": np.ones(3)})
    assert design.with_role("b", np.zeros(1)).roles["a"] is design.roles["a"]


def test_a_list_of_numbers_is_an_array() -> None:
    roles: Any = {"a": [1.0, 2.0]}  # as scripts may pass it
    assert Design(roles).roles["a"].tolist() == [1.0, 2.0]


def test_designs_and_outcomes_are_compared_by_identity() -> None:
    """Comparing arrays has no single truth value; ``==`` must not raise."""
    first, second = (Design({"a": np.ones(2)}) for _ in range(2))
    assert first != second
    outcomes = [Outcome(np.zeros(2, np.int64), np.zeros(2), {}) for _ in range(2)]
    assert outcomes[0] != outcomes[1]


def test_turns_are_compared_without_their_workload() -> None:
    turn = Turn(1, (), (Pair((1, 2), 0.5),), None, Workload(1, 1, 0.25))
    assert attrs.evolve(turn, workload=Workload(1, 0, 9.0)) == turn
    assert attrs.evolve(turn, pairs=(Pair((1, 2), 0.25),)) != turn


@pytest.mark.parametrize("name", [name for name in values.__all__ if name not in ("Choice", "Scores")])
def test_values_cannot_be_changed(name: str) -> None:
    assert attrs.inspect(getattr(values, name)).is_frozen


def test_defaults_of_values() -> None:
    assert Record(("a",)) == Record(("a",), every=0.0, samples=None, initial=False, until=0.0)
    assert Member(1, None) == Member(1, None, None, 0, 0, diverged=False)
    assert (Score(0.5).diverged_at, Pair((1,), 0.5).diverged_at) == (None, None)


def test_values_with_arrays_and_members_print_in_a_few_lines(toy_config: Callable[..., RunConfig]) -> None:
    with assemble(toy_config()) as coevolution:
        turn = next(iter(coevolution))
    assert turn.best_pair is not None
    for value in (turn, turn.best_pair, turn.best_pair.design):
        assert len(str(value)) < 1000
        assert "\n" not in str(value)
    assert str(Design({"morphology": np.zeros((20, 8, 8), np.uint8)})) == (
        "Design(roles=morphology: uint8[20, 8, 8])"
    )


lengths = st.lists(st.none() | st.integers(0, 3), max_size=3).map(tuple)
types = st.builds(ArrayType, dtype=st.sampled_from(["uint8", "float64"]), shape=lengths)


class TestArrayTypes:
    @given(numbers)
    def test_of_an_array_accept_it(self, array: NDArray[Any]) -> None:
        own = ArrayType.of(array)
        assert own.accepts(own)
        assert ArrayType(own.dtype, (None,) * array.ndim).accepts(own)
        assert not ArrayType("int16", own.shape).accepts(own)
        assert not ArrayType(own.dtype, (*own.shape, None)).accepts(own)

    @given(types, types)
    def test_accept_each_other_if_an_array_can_have_both(self, one: ArrayType, other: ArrayType) -> None:
        assert one.accepts(other) == other.accepts(one)
        if one.accepts(other):
            both = zip(one.shape, other.shape, strict=True)
            shape = tuple(next((each for each in pair if each is not None), 1) for pair in both)
            there = ArrayType.of(np.zeros(shape, one.dtype))
            assert one.accepts(there)
            assert other.accepts(there)

    def test_are_written_with_the_lengths_of_their_axes(self) -> None:
        assert str(ArrayType("uint8", (20, None, 8))) == "uint8[20, any, 8]"
        assert str(ArrayType("float64", ())) == "float64[]"
        assert str(ArrayType.of(np.zeros((2, 3)))) == "float64[2, 3]"


class TestScoredMeetings:
    def test_of_a_population_are_grouped_by_member_and_leave_archived_ones_out(self) -> None:
        members = tuple(Member(i, 0.5) for i in range(3))
        meetings = np.array([[2, 0], [0, 0], [2, 1], [0, 1]], dtype=np.intp)
        seen = ScoredMeetings(3, ("a", "b"), (members, members), (2, 1), meetings, np.arange(4.0))
        assert [rows.tolist() for rows in seen.of(0)] == [[1, 3], []]
        assert [rows.tolist() for rows in seen.of(1)] == [[0, 1]]

    def test_print_in_a_line(self) -> None:
        meetings = np.zeros((500, 2), dtype=np.intp)
        members = (tuple(Member(i, None) for i in range(25)), (Member(0, None),))
        text = str(ScoredMeetings(3, ("a", "b"), members, (25, 1), meetings, np.zeros(500)))
        assert "members=[25, 1]" in text
        assert len(text) < 200
