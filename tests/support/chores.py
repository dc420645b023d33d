"""Functions for workers to call, which import this module."""

from __future__ import annotations

import ctypes
import os
import resource
import signal
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from evoframe.workers import report


def square(item: int) -> int:
    return item * item


def process(_: object) -> int:
    return os.getpid()


def hang(item: object) -> object:
    """Hang for an hour, longer than any test; return -1 at once."""
    if item != -1:
        time.sleep(3600)
    return item


def hang_once(marker: Path) -> str:
    if not marker.exists():
        marker.touch()
        time.sleep(3600)
    return "done"


def end_process(code: int) -> int:
    """End the process with an exit code, or with a signal if *code* is negative; return 0 at once."""
    if code > 0:
        os._exit(code)
    if code < 0:
        os.kill(os.getpid(), -code)
        signal.pause()
    return code


def end_process_silently(item: int) -> int:
    if item:
        os._exit(0)
    return item


def keep_the_lock(path: Path) -> None:
    """Hang without releasing the GIL, as a simulator in C could do."""
    path.write_text(str(os.getpid()))
    ctypes.PyDLL(None).sleep(3600)


def exit_in_initializer(code: int) -> None:
    os._exit(code)


def fail_with_output(text: bytes) -> None:
    os.write(2, text)
    os._exit(4)


def fork_and_end(code: int) -> None:
    """End this process, but not its fork, which lives for a while."""
    if os.fork() == 0:
        time.sleep(20)
        os._exit(0)
    os._exit(code)


def use_memory(limit: int) -> None:
    """Limit the memory of this process, and use more."""
    resource.setrlimit(resource.RLIMIT_AS, (limit, limit))
    bytearray(limit)


def write(descriptor: int, text: bytes) -> None:
    os.write(descriptor, text)


def advance_and_end(directory: Path) -> int:
    """Report, and end the process, unless it has been called eight times; return the number of calls."""
    calls = len(list(directory.iterdir()))
    (directory / str(calls)).touch()
    if calls < 8:
        report(calls)
        os._exit(3)
    return calls + 1


def size(item: bytes) -> int:
    return len(item)


def end_process_once(marker: Path) -> str:
    if not marker.exists():
        marker.touch()
        os._exit(3)
    return "done"


def fail(item: int) -> int:
    """Fail unless *item* is 0: with an exception that can be pickled, or with one that cannot."""
    if item == 1:
        raise ZeroDivisionError("item 1")
    if item == 2:
        raise UnusualError("item", 2)
    if item == 3:
        sys.exit("item 3")
    return item


class UnusualError(Exception):
    def __init__(self, what: str, number: int) -> None:
        super().__init__(f"{what} {number}")


def give_a_lock(_: object) -> object:
    return threading.Lock()


def write_process_and_hang(path: Path) -> None:
    path.write_text(str(os.getpid()))
    time.sleep(3600)


def mark(path: Path | None) -> None:
    time.sleep(0.05)
    if path is None:
        raise FileNotFoundError
    path.touch()


class UnknownElsewhere:
    """An object that can be pickled, but not unpickled in another process."""

    def __reduce__(self) -> tuple[Callable[..., Any], tuple[Any, ...]]:
        return (known_here_only, (os.getpid(),))


def known_here_only(process: int) -> int:
    if os.getpid() != process:
        raise ModuleNotFoundError("No module named 'my_simulator'")
    return process
