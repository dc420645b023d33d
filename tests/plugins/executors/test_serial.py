"""One worker: the thread that asks."""

import threading

import pytest
from hypothesis import given, strategies as st

from evoframe.testing import ExecutorContract
from evoframe_executors import Serial


class TestSerial(ExecutorContract):
    component = Serial()


def test_one_worker_is_the_thread_that_asks() -> None:
    run = Serial().start()
    assert run.workers == 1
    assert set(run.map(lambda _: threading.get_ident(), range(20))) == {threading.get_ident()}


@given(st.lists(st.integers()))
def test_items_are_worked_on_in_their_order(items: list[int]) -> None:
    begun: list[int] = []
    Serial().start().map(begun.append, items)
    assert begun == items


def test_after_a_failure_nothing_is_begun() -> None:
    begun: list[int] = []

    def work(item: int) -> None:
        begun.append(item)
        if item == 2:
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        Serial().start().map(work, range(10))
    assert begun == [0, 1, 2]
