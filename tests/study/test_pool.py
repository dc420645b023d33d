"""Workers of a study: the loss of one does not affect the others."""

from __future__ import annotations

import contextlib
import os
import signal
import time
from collections.abc import Iterator
from concurrent.futures import Future
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path

import pebble
import pytest
from chatter import chatter

from evoframe.config.layers import Layers
from evoframe.study.pool import End, Pool, end_of
from evoframe.study.worker import Order

LOST, OTHER = Path("lost"), Path("other")


@pytest.fixture
def pool() -> Iterator[Pool]:
    with contextlib.closing(Pool(2)) as pool:
        pool._orders += [Order(directory, Layers(()), "", ()) for directory in (LOST, OTHER)]
        yield pool


def reports(pool: Pool, about: Path) -> Iterator[int]:
    """Yield the ids of the processes that report on a run."""
    until = time.monotonic() + 30
    while time.monotonic() < until:
        for directory, process, _ in pool.news():
            if directory == about:
                yield process
                until = time.monotonic() + 30
    raise AssertionError(f"no report on {about}")


def test_the_others_continue_when_one_is_killed_while_it_reports(pool: Pool) -> None:
    other = pool._processes.schedule(chatter, [1])
    killed: set[int] = set()
    for _ in range(8):
        lost = pool._processes.schedule(chatter, [0])
        # Pebble loses track of work whose process is killed before pebble knows that it has started.
        process = next(each for each in reports(pool, LOST) if each not in killed and lost.running())
        os.kill(process, signal.SIGKILL)
        killed.add(process)
        with pytest.raises(pebble.ProcessExpired):
            lost.result(60)
        for _, _ in zip(range(10_000), reports(pool, OTHER), strict=False):
            pass  # more than the pipe held before: its capacity is 65,536 bytes
    assert not other.done()
    pool.request_stop()
    pool.request_stop()
    for _ in pool.news():
        pass
    other.result(60)


def expired(code: int) -> Exception:
    return pebble.ProcessExpired("", code)  # type: ignore[no-untyped-call]


@pytest.mark.parametrize(
    ("error", "cause"),
    [
        (expired(-signal.SIGKILL), "SIGKILL"),
        (expired(3), "exit code 3"),
        (BrokenProcessPool(), "no worker"),
    ],
)
def test_work_whose_process_was_lost_has_failed(error: Exception, cause: str) -> None:
    future: Future[End] = Future()
    future.set_exception(error)
    assert end_of(future).state == "failed"
    assert cause in end_of(future).cause
