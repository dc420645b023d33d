"""Locks of run directories and of the files that the processes of a study share."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from pathlib import Path

import filelock

from evoframe.errors import InputError, LockedError

__all__ = ["LOCK_FILE", "Lock", "acquire_lock", "locked", "locked_after_others", "released_on_error"]

LOCK_FILE = "run.lock"
"""Name of the lock file; it is never removed, since two processes could then lock two files of this name."""

Lock = filelock.BaseFileLock


def acquire_lock(directory: Path) -> Lock:
    """Lock a run directory and return the lock; the end of this process releases it, even after a kill.

    Raises:
        LockedError: Another process holds the lock.
        InputError: The directory cannot be written.
    """
    lock = filelock.FileLock(directory / LOCK_FILE, timeout=0)
    try:
        lock.acquire()
    except filelock.Timeout as error:
        raise LockedError(
            "another process is writing to this directory; wait until it ends, or stop it", source=directory
        ) from error
    except OSError as error:
        raise InputError(f"cannot be used as a run directory: {error.strerror}", source=directory) from error
    return lock


@contextlib.contextmanager
def released_on_error(lock: Lock) -> Iterator[None]:
    """Release the lock if the block fails; otherwise keep it."""
    try:
        yield
    except BaseException:
        lock.release()
        raise


@contextlib.contextmanager
def locked(directory: Path) -> Iterator[None]:
    """Hold the lock of a run directory during the block.

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
    """Wait until other processes release a lock, then hold it during the block.

    Args:
        path: The lock file, which is never removed, as :data:`LOCK_FILE`.

    Raises:
        InputError: The lock file cannot be written.
    """
    lock = filelock.FileLock(path)
    try:
        lock.acquire()
    except OSError as error:
        raise InputError(f"cannot be written: {error.strerror}", source=path) from error
    try:
        yield
    finally:
        lock.release()
