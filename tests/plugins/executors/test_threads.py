"""Threads: distribution of the items, failures, time limits and interrupts."""

import itertools
import os
import threading
import time
from collections.abc import Callable, Iterator

import pytest
from hypothesis import given, strategies as st
from processes import LIMIT

from evoframe import Executor, ExecutorRun, WorkerError
from evoframe.testing import ExecutorContract
from evoframe_executors import Threads
from evoframe_executors.threads import _Batch

SLOW = 0.2  # s; 100 items take far longer than a computer can be busy with something else


class TestThreads(ExecutorContract):
    component = Threads()


class TestOneThread(ExecutorContract):
    component = Threads(workers=1)


class TestTwoThreads(ExecutorContract):
    component = Threads(workers=2)


class TestManyThreads(ExecutorContract):
    component = Threads(workers=16)


class TestOneWatchedThread(ExecutorContract):
    component = Threads(workers=1, batch_time_limit=LIMIT)


class TestTwoWatchedThreads(ExecutorContract):
    component = Threads(workers=2, batch_time_limit=LIMIT)


@pytest.fixture(params=[Threads(workers=2), Threads(workers=2, batch_time_limit=LIMIT)], ids=["", "watched"])
def two_threads(request: pytest.FixtureRequest) -> Iterator[ExecutorRun]:
    run: ExecutorRun = request.param.start()
    yield run
    run.close()


def threads_used(executor: Executor) -> set[int]:
    run = executor.start()
    try:
        return set(run.map(lambda _: threading.get_ident(), range(20)))
    finally:
        run.close()


def test_a_single_worker_is_the_calling_thread() -> None:
    assert Threads(workers=1).start().workers == 1
    assert threads_used(Threads(workers=1)) == {threading.get_ident()}


def test_several_workers_run_in_parallel() -> None:
    run = Threads(workers=3).start()
    meeting = threading.Barrier(3, timeout=LIMIT)  # no thread passes until all three have arrived
    try:
        assert sorted(run.map(lambda _: meeting.wait(), range(3))) == [0, 1, 2]
    finally:
        run.close()


def test_threads_end_with_close() -> None:
    before = threading.active_count()
    threads_used(Threads(workers=4))
    assert threading.active_count() == before


@pytest.mark.parametrize(("cores", "workers"), [(6, 6), (1, 1), (None, 1)])
def test_zero_workers_is_one_per_core_of_the_process(
    monkeypatch: pytest.MonkeyPatch, cores: int | None, workers: int
) -> None:
    monkeypatch.setattr(os, "process_cpu_count", lambda: cores, raising=False)
    run = Threads().start()
    assert run.workers == workers
    run.close()


def test_before_python_3_13_the_affinity_counts(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delattr(os, "process_cpu_count", raising=False)
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: {0, 2, 5}, raising=False)
    run = Threads().start()
    assert run.workers == 3
    run.close()


def test_without_affinity_all_cores_count(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delattr(os, "process_cpu_count", raising=False)
    monkeypatch.delattr(os, "sched_getaffinity", raising=False)
    monkeypatch.setattr(os, "cpu_count", lambda: 5)
    run = Threads().start()
    assert run.workers == 5
    run.close()


def test_after_a_failure_no_new_item_is_started(two_threads: ExecutorRun) -> None:
    started = []

    def fail_at_once(item: int) -> None:
        started.append(item)
        if item == 0:
            raise ZeroDivisionError
        time.sleep(SLOW)

    with pytest.raises(ZeroDivisionError):
        two_threads.map(fail_at_once, range(1000))
    assert len(started) < 100


def test_after_a_failure_no_work_continues(two_threads: ExecutorRun) -> None:
    finished = []

    def slow_or_failing(item: int) -> None:
        if item == 0:
            raise ZeroDivisionError
        time.sleep(0.05)
        finished.append(item)

    with pytest.raises(ZeroDivisionError):
        two_threads.map(slow_or_failing, range(100))
    so_far = list(finished)
    time.sleep(0.1)
    assert finished == so_far


def test_the_first_items_are_processed_while_the_next_are_created(two_threads: ExecutorRun) -> None:
    started = threading.Event()

    def items() -> Iterator[Callable[[], object]]:
        yield started.set
        assert started.wait(LIMIT)
        yield started.is_set

    assert two_threads.map(lambda item: item(), items()) == [None, True]


def test_after_a_failure_no_more_items_are_requested(two_threads: ExecutorRun) -> None:
    with pytest.raises(ZeroDivisionError):
        two_threads.map(lambda item: 1 / item, itertools.repeat(0))


@pytest.mark.parametrize("error", [KeyError, KeyboardInterrupt])
def test_if_creating_an_item_fails_no_work_continues(
    two_threads: ExecutorRun, error: type[BaseException]
) -> None:
    finished = []

    def slow(item: int) -> None:
        time.sleep(0.05)
        finished.append(item)

    def items() -> Iterator[int]:
        yield from range(3)
        raise error("items")

    with pytest.raises(error, match="items"):
        two_threads.map(slow, items())
    so_far = list(finished)
    time.sleep(0.1)
    assert finished == so_far


def test_an_earlier_failure_takes_precedence_over_one_in_creating_an_item(two_threads: ExecutorRun) -> None:
    def slow_failure(_: int) -> None:
        time.sleep(0.02)
        raise ZeroDivisionError

    def items() -> Iterator[int]:
        yield 1
        raise KeyError("items")

    with pytest.raises(ZeroDivisionError):
        two_threads.map(slow_failure, items())


def test_an_interrupt_while_items_are_created_drops_the_rest(two_threads: ExecutorRun) -> None:
    started = []

    def work(item: int) -> None:
        started.append(item)
        time.sleep(SLOW)

    def items() -> Iterator[int]:
        yield from range(1000)
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        two_threads.map(work, items())
    assert len(started) < 100


def test_an_interrupt_while_the_caller_helps_drops_the_rest() -> None:
    caller, started = threading.get_ident(), []

    def work(item: int) -> None:
        started.append(item)
        time.sleep(SLOW)
        if threading.get_ident() == caller:
            raise KeyboardInterrupt

    run = Threads(workers=2).start()
    try:
        with pytest.raises(KeyboardInterrupt):
            run.map(work, range(1000))
    finally:
        run.close()
    assert len(started) < 100


@pytest.mark.parametrize("workers", [1, 2])
def test_a_hanging_thread_is_reported_and_abandoned(workers: int) -> None:
    released = threading.Event()
    run = Threads(workers=workers, batch_time_limit=2.0).start()

    def work(item: int) -> None:
        if item == 3:
            released.wait(LIMIT)

    try:
        with pytest.raises(WorkerError, match=r"executor\.batch_time_limit = 2\.0 s") as caught:
            run.map(work, range(10))
        assert caught.value.item == 3
    finally:
        run.close()
        released.set()


def test_the_time_limit_counts_from_the_start_of_an_item() -> None:
    run = Threads(workers=1, batch_time_limit=2.0).start()
    try:
        assert run.map(lambda _: time.sleep(0.25), range(10)) == [None] * 10
    finally:
        run.close()


def fail_if_odd(item: int) -> int:
    if item % 2:
        raise ZeroDivisionError(f"item {item}")
    return item


@given(st.permutations(range(6)))
def test_only_tasks_after_a_failure_are_dropped(order: list[int]) -> None:
    batch = _Batch(fail_if_odd)
    tasks = [batch.add(item) for item in range(6)]
    failed: list[int] = []
    for place in order:  # in any order in which threads may start them
        tasks[place].work()
        assert tasks[place].future.cancelled() == any(other < place for other in failed)
        if place % 2 and not tasks[place].future.cancelled():
            failed.append(place)
    assert tasks[0].future.result() == 0
    with pytest.raises(ZeroDivisionError, match=r"^item 1$"):
        tasks[1].future.result()


def test_each_task_is_processed_once() -> None:
    run, started = Threads(workers=3).start(), list[int]()
    try:
        run.map(started.append, range(1000))
    finally:
        run.close()
    assert sorted(started) == list(range(1000))
