"""Parcels between processes: what comes out is what went in, and what cannot travel is said."""

from __future__ import annotations

from typing import Any

import chores
import numpy as np
import pytest
from hypothesis import given, strategies as st

from evoframe import RunError
from evoframe_executors.worker import answered, packed, unpacked

VALUES = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | st.text() | st.binary(),
    lambda inner: st.lists(inner) | st.tuples(inner, inner) | st.dictionaries(st.text(), inner),
)


def identity(item: Any) -> Any:
    return item


def through(function: Any, item: Any) -> Any:
    return unpacked(answered(packed(function, item)))


@given(VALUES)
def test_a_value_is_the_same_on_the_other_side(value: Any) -> None:
    assert through(identity, value) == value


def test_an_array_is_the_same_to_the_last_bit() -> None:
    array = np.random.default_rng(0).normal(size=(3, 4))
    assert through(identity, array).tobytes() == array.tobytes()


def test_whether_a_function_succeeded_is_known_before_its_parcel_is_opened() -> None:
    assert answered(packed(chores.square, 3)).succeeded
    assert not answered(packed(chores.fail, 1)).succeeded


def test_an_error_is_raised_with_its_traceback() -> None:
    with pytest.raises(ZeroDivisionError, match="item 1") as caught:
        through(chores.fail, 1)
    [note] = caught.value.__notes__
    assert note.startswith("In a worker process:\n")
    assert 'raise ZeroDivisionError("item 1")' in note


def test_an_error_that_cannot_be_made_again_comes_as_text() -> None:
    with pytest.raises(RunError, match=r"^UnusualError: item 2$"):
        through(chores.fail, 2)


def test_what_would_end_the_worker_is_raised() -> None:
    with pytest.raises(SystemExit, match="item 3"):
        through(chores.fail, 3)


def test_a_function_that_cannot_be_sent_is_refused_where_it_is_packed() -> None:
    with pytest.raises(RunError, match=r"what a worker shall do cannot be sent to it: .*lambda"):
        packed(lambda item: item, 1)


@pytest.mark.parametrize("parcel", [b"", b"not a parcel"])
def test_a_parcel_that_cannot_be_opened_is_answered(parcel: bytes) -> None:
    answer = answered(parcel)
    assert not answer.succeeded
    with pytest.raises(RunError, match="a worker does not know what it shall do: "):
        unpacked(answer)


def test_a_result_that_cannot_travel_is_answered() -> None:
    with pytest.raises(
        RunError, match=r"a result cannot be sent back: TypeError: .*work with 'threads' only$"
    ):
        through(chores.give_a_lock, 1)
