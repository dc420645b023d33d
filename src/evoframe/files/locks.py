"""What is written by one process at a time: a run's directory, and what the processes of a study share."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from pathlib import Path

import filelock

from evoframe.errors import InputError, LockedError

__all__ = ["LOCK_FILE", "Lock", "acquire_lock", "locked", "locked_after_others", "released_on_error"]

LOCK_FILE = "run.lock"
"""Stays in the directory: to remove it would let two processes lock two files of one name."""

Lock = filelock.BaseFileLock


def acquire_lock(directory: Path) -> Lock:
    """Return the lock of a run's directory, which ends with this process at the latest, however it ends.

    Raises:
        LockedError: Another process has it.
        InputError: The directory cannot be written.
    """
    lock = filelock.FileLock(directory / LOCK_FILE, timeout=0)
    try:
        lock.acquire()
    except filelock.Timeout as error:
        raise LockedError(
            f"{directory}: is being written by another process; wait until it has ended, or end it"
        ) from error
    except OSError as error:
        raise InputError(f"{directory}: cannot be used for a run: {error.strerror}") from error
    return lock


@contextlib.contextmanager
def released_on_error(lock: Lock) -> Iterator[None]:
    """Give the lock back if what follows fails; else it is somebody's to keep."""
    try:
        yield
    except BaseException:
        lock.release()
        raise


@contextlib.contextmanager
def locked(directory: Path) -> Iterator[None]:
    """Have the lock of a run's directory for as long as what follows takes.

    Raises:
        LockedError: As :func:`acquire_lock`.
        InputError: As :func:`acquire_lock`.
    """
    lock = acquire_lock(directory)
    try:
        yield
    finally:
        lock.release()


@contextlib.contextmanager
def locked_after_others(path: Path) -> Iterator[None]:
    """Have a lock for as long as what follows takes; wait for the processes that have it before.

    Args:
        path: A file of its own, which stays, as :data:`LOCK_FILE` does.

    Raises:
        InputError: It cannot be written.
    """
    lock = filelock.FileLock(path)
    try:
        lock.acquire()
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror}") from error
    try:
        yield
    finally:
        lock.release()
