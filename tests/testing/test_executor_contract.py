import contextlib
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor, as_completed
from typing import Any, ClassVar

import attrs
import pytest
from contracts import starting

from evoframe.testing import ExecutorContract

STARTS = "test_it_starts_workers"
EVERY = "test_every_item_has_its_result"
ORDER = "test_results_come_in_the_order_of_the_items"
GENERATOR = "test_items_may_come_from_a_generator"
THREAD = "test_items_are_requested_in_the_calling_thread"
NO_ITEM = "test_an_exception_of_the_generator_is_raised"
RAISED = "test_the_exception_of_the_first_failing_item_is_raised"
SURVIVE = "test_workers_survive_an_exception"
AGAIN = "test_workers_can_be_started_again"


class Run:
    """Valid workers, and the base of the broken ones."""

    workers = 2

    def __init__(self) -> None:
        self.pool = ThreadPoolExecutor(2)

    def map(self, function: Callable[[Any], Any], items: Iterable[Any]) -> list[Any]:
        return list(self.pool.map(function, items))

    def close(self) -> None:
        self.pool.shutdown()


@attrs.frozen
class Pool:
    """A valid executor, and the base of the broken ones."""

    run: ClassVar[type[Any]] = Run

    def start(self) -> Any:
        return self.run()


class TestPool(ExecutorContract):
    component = Pool()


class NoWorkers(Run):
    workers = 0


class NoClose:
    workers = 1


class AsCompleted(Run):
    def map(self, function: Callable[[Any], Any], items: Iterable[Any]) -> list[Any]:
        futures = [self.pool.submit(function, item) for item in items]
        return [future.result() for future in as_completed(futures)]


class OnlyTwo(Run):
    def map(self, function: Callable[[Any], Any], items: Iterable[Any]) -> list[Any]:
        return super().map(function, list(items)[:2])


class ReadsTwice(Run):
    def map(self, function: Callable[[Any], Any], items: Iterable[Any]) -> list[Any]:
        n = sum(1 for _ in items)
        return super().map(function, items)[:n]


class ReadsInAnotherThread(Run):
    def map(self, function: Callable[[Any], Any], items: Iterable[Any]) -> list[Any]:
        return super().map(function, self.pool.submit(list, items).result())


class StopsEarly(Run):
    def map(self, function: Callable[[Any], Any], items: Iterable[Any]) -> list[Any]:
        created: list[Any] = []
        with contextlib.suppress(KeyError):
            created.extend(items)
        return super().map(function, created)


class Swallows(Run):
    def map(self, function: Callable[[Any], Any], items: Iterable[Any]) -> list[Any]:
        results = []
        for item in items:
            try:
                results.append(function(item))
            except ZeroDivisionError:
                results.append(None)
        return results


class DiesOfAnException(Run):
    def map(self, function: Callable[[Any], Any], items: Iterable[Any]) -> list[Any]:
        try:
            return super().map(function, items)
        except ZeroDivisionError:
            self.close()
            raise


class Shared(Run):
    pools: ClassVar[list[ThreadPoolExecutor]] = []

    def __init__(self) -> None:
        if not self.pools:
            self.pools.append(ThreadPoolExecutor(2))
        self.pool = self.pools[0]


@pytest.mark.parametrize(
    ("run", "law", "error"),
    [
        (NoWorkers, STARTS, AssertionError),
        (AsCompleted, ORDER, AssertionError),
        (OnlyTwo, EVERY, AssertionError),
        (ReadsTwice, GENERATOR, AssertionError),
        (ReadsInAnotherThread, THREAD, AssertionError),
        (StopsEarly, NO_ITEM, pytest.fail.Exception),
        (Swallows, RAISED, pytest.fail.Exception),
        (DiesOfAnException, SURVIVE, RuntimeError),
        (Shared, AGAIN, RuntimeError),
        (NoClose, STARTS, AttributeError),
    ],
)
def test_broken_workers_are_caught(
    run: type[Any], law: str, error: type[Exception], breaks: Callable[..., None]
) -> None:
    breaks(ExecutorContract, starting(run, Pool), law, error=error)
