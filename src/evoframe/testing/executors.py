"""The laws of executors."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from evoframe.contract import Executor, ExecutorRun
from evoframe.testing.components import ComponentContract

__all__ = ["ExecutorContract"]


class ExecutorContract(ComponentContract[Executor]):
    """The laws of an :class:`~evoframe.Executor` and of the workers that it starts.

    The functions that are mapped stand in a module, for executors that use other processes.
    """

    protocol = Executor

    def test_it_starts_workers(self) -> None:
        """At least one."""
        with self._started() as run:
            assert isinstance(run, ExecutorRun)
            assert run.workers >= 1

    def test_every_item_has_its_result(self) -> None:
        """For any number of items, however many workers there are."""
        with self._started() as run:
            for n in (0, 1, run.workers, 10 * run.workers + 1):
                assert run.map(_square, range(n)) == [_square(item) for item in range(n)]

    def test_results_come_in_the_order_of_the_items(self) -> None:
        """Though the first items take the longest."""
        delays = [0.02, 0.01, 0.0, 0.005, 0.0, 0.0]
        with self._started() as run:
            assert run.map(_sleep, delays) == delays

    def test_items_may_come_from_a_generator(self) -> None:
        """Which is read once."""
        with self._started() as run:
            assert run.map(_square, iter([3, 1, 2])) == [9, 1, 4]

    def test_items_are_asked_for_where_map_is_called(self) -> None:
        """In that thread: what makes the items may not like others."""
        asked: list[int] = []

        def items() -> Iterator[int]:
            for item in range(5):
                asked.append(threading.get_ident())
                yield item

        with self._started() as run:
            run.map(_square, items())
        assert asked == [threading.get_ident()] * 5

    def test_an_exception_of_the_items_is_raised(self) -> None:
        """What cannot be made is not left out."""
        with self._started() as run, pytest.raises(KeyError, match="no item 2"):
            run.map(_square, _two_items())

    def test_an_exception_is_raised_where_map_is_called(self) -> None:
        """That of the first item which fails, as if the items were worked on one by one."""
        with self._started() as run, pytest.raises(ZeroDivisionError) as caught:
            run.map(_fail_from_two_on, [0, 1, 2, 3, 4, 5])
        assert str(caught.value) == "item 2"

    def test_workers_survive_an_exception(self) -> None:
        """The next items are worked on as ever."""
        with self._started() as run:
            with pytest.raises(ZeroDivisionError):
                run.map(_fail_from_two_on, [2, 0])
            assert run.map(_fail_from_two_on, [0, 1]) == [0, 1]

    def test_workers_can_be_started_again(self) -> None:
        """After others were let go, and beside them."""
        with self._started() as one:
            with self._started() as other:
                assert one.map(_square, [1, 2]) == other.map(_square, [1, 2])
            assert one.map(_square, [3]) == [9]

    @contextmanager
    def _started(self) -> Iterator[ExecutorRun]:
        run = self.component.start()
        try:
            yield run
        finally:
            run.close()


def _square(item: int) -> int:
    return item * item


def _two_items() -> Iterator[int]:
    yield 0
    yield 1
    raise KeyError("no item 2")


def _sleep(delay: float) -> float:
    time.sleep(delay)
    return delay


def _fail_from_two_on(item: int) -> int:
    if item >= 2:
        # The later an item, the sooner it fails: the first failure in time is not the first in order.
        time.sleep(0.02 / item)
        raise ZeroDivisionError(f"item {item}")
    return item
