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

    The mapped functions are defined in a module, so that executors can send them to other processes.
    """

    protocol = Executor

    def test_it_starts_workers(self) -> None:
        """``start`` returns an ``ExecutorRun`` with at least one worker."""
        with self._started() as run:
            assert isinstance(run, ExecutorRun), "start() must return an ExecutorRun; a member is missing"
            assert run.workers >= 1, f"expected at least 1 worker, found {run.workers}"

    def test_every_item_has_its_result(self) -> None:
        """``map`` returns one result per item, for any number of items and workers."""
        with self._started() as run:
            for n in (0, 1, run.workers, 10 * run.workers + 1):
                expected = [_square(item) for item in range(n)]
                assert run.map(_square, range(n)) == expected, (
                    f"map() must return the results of all {n} items"
                )

    def test_results_come_in_the_order_of_the_items(self) -> None:
        """Results are in the order of the items, even if the first items take the longest."""
        delays = [0.02, 0.01, 0.0, 0.005, 0.0, 0.0]
        with self._started() as run:
            assert run.map(_sleep, delays) == delays, "map() must return results in the order of the items"

    def test_items_may_come_from_a_generator(self) -> None:
        """``map`` iterates over the items only once."""
        with self._started() as run:
            results = run.map(_square, iter([3, 1, 2]))
            assert results == [9, 1, 4], "map() must accept a generator, and iterate over it only once"

    def test_items_are_requested_in_the_calling_thread(self) -> None:
        """The generator of the items runs in the thread that calls ``map``."""
        threads: list[int] = []

        def items() -> Iterator[int]:
            for item in range(5):
                threads.append(threading.get_ident())
                yield item

        with self._started() as run:
            run.map(_square, items())
        assert threads == [threading.get_ident()] * 5, (
            "map() must iterate over the items in the calling thread"
        )

    def test_an_exception_of_the_generator_is_raised(self) -> None:
        """An exception in the generator of the items is raised by ``map``."""
        with self._started() as run, pytest.raises(KeyError, match="no item 2"):
            run.map(_square, _two_items())

    def test_the_exception_of_the_first_failing_item_is_raised(self) -> None:
        """``map`` raises the exception that processing the items one by one would raise."""
        with self._started() as run, pytest.raises(ZeroDivisionError) as caught:
            run.map(_fail_from_two_on, [0, 1, 2, 3, 4, 5])
        assert str(caught.value) == "item 2", "map() must raise the exception of the first failing item"

    def test_workers_survive_an_exception(self) -> None:
        """After an exception, ``map`` processes further items."""
        with self._started() as run:
            with pytest.raises(ZeroDivisionError):
                run.map(_fail_from_two_on, [2, 0])
            assert run.map(_fail_from_two_on, [0, 1]) == [0, 1], "map() must work after an exception"

    def test_workers_can_be_started_again(self) -> None:
        """Workers can be started while others are running, and after others were shut down."""
        with self._started() as one:
            with self._started() as other:
                assert one.map(_square, [1, 2]) == other.map(_square, [1, 2]) == [1, 4], (
                    "workers started side by side must not affect each other"
                )
            assert one.map(_square, [3]) == [9], "close() must not shut down the workers of another run"

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
