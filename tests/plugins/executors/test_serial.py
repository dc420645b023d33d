"""The single worker of ``serial``: the calling thread."""

import threading

import pytest
from hypothesis import given, strategies as st

from evoframe.testing import ExecutorContract
from evoframe_executors import Serial


class TestSerial(ExecutorContract):
    component = Serial()


def test_the_worker_is_the_calling_thread() -> None:
    run = Serial().start()
    assert run.workers == 1
    assert set(run.map(lambda _: threading.get_ident(), range(20))) == {threading.get_ident()}


@given(st.lists(st.integers()))
def test_items_are_processed_in_their_order(items: list[int]) -> None:
    started: list[int] = []
    Serial().start().map(started.append, items)
    assert started == items


def test_after_a_failure_no_item_is_started() -> None:
    started: list[int] = []

    def work(item: int) -> None:
        started.append(item)
        if item == 2:
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        Serial().start().map(work, range(10))
    assert started == [0, 1, 2]
