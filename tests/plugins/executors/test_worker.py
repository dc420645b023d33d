"""Parcels between processes: their content is unchanged, and failed transfers are reported."""

from __future__ import annotations

from multiprocessing.reduction import ForkingPickler
from typing import Any

import chores
import numpy as np
import pytest
from hypothesis import given, strategies as st

from evoframe import RunError
from evoframe_executors.worker import Call, execute, pack, unpack

VALUES = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | st.text() | st.binary(),
    lambda inner: st.lists(inner) | st.tuples(inner, inner) | st.dictionaries(st.text(), inner),
)


def identity(item: Any) -> Any:
    return item


def sent(call: Call) -> Any:
    """Return a call as it arrives in a worker."""
    return ForkingPickler.loads(ForkingPickler.dumps(call))


def through(function: Any, item: Any) -> Any:
    return unpack(execute(sent(pack(function, item))))


@given(VALUES)
def test_a_value_is_the_same_on_the_other_side(value: Any) -> None:
    assert through(identity, value) == value


def test_an_array_is_the_same_to_the_last_bit() -> None:
    array = np.random.default_rng(0).normal(size=(3, 4))
    assert through(identity, array).tobytes() == array.tobytes()


def test_success_is_known_before_the_parcel_is_unpacked() -> None:
    assert execute(sent(pack(chores.square, 3))).succeeded
    assert not execute(sent(pack(chores.fail, 1))).succeeded


def test_an_error_is_raised_with_its_traceback() -> None:
    with pytest.raises(ZeroDivisionError, match="item 1") as caught:
        through(chores.fail, 1)
    [note] = caught.value.__notes__
    assert "worker process" in note.splitlines()[0]
    assert 'raise ZeroDivisionError("item 1")' in note


def test_an_error_that_cannot_be_recreated_is_raised_as_text() -> None:
    with pytest.raises(RunError, match=r"^UnusualError: item 2$"):
        through(chores.fail, 2)


def test_an_exception_that_would_end_the_worker_is_raised() -> None:
    with pytest.raises(SystemExit, match="item 3"):
        through(chores.fail, 3)


def test_a_function_that_cannot_be_sent_is_refused_by_pack() -> None:
    with pytest.raises(RunError, match=r"send a .*lambda") as caught:
        pack(lambda item: item, 1)
    assert caught.value.key == "executor"


@pytest.mark.parametrize("parcel", [b"", b"not a parcel"])
def test_an_invalid_parcel_is_answered_by_an_error(parcel: bytes) -> None:
    answer = execute(sent(Call(parcel)))
    assert not answer.succeeded
    with pytest.raises(RunError, match="load a") as caught:
        unpack(answer)
    assert caught.value.key == "executor"


def test_a_result_that_cannot_be_sent_is_answered_by_an_error() -> None:
    with pytest.raises(RunError, match=r"return a .*TypeError: .*executor=threads$") as caught:
        through(chores.give_a_lock, 1)
    assert caught.value.key == "executor"
