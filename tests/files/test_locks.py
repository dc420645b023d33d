"""Tests of locks: one process at a time, and no lock outlives its process."""

from __future__ import annotations

import subprocess
import sys
import threading
from pathlib import Path

import pytest
from processes import LIMIT, surroundings

from evoframe import InputError
from evoframe.errors import LockedError
from evoframe.files.locks import LOCK_FILE, acquire_lock, locked, locked_after_others, released_on_error

HOLDER = """
import pathlib, sys, time
from evoframe.files.locks import acquire_lock
lock = acquire_lock(pathlib.Path(sys.argv[1]))
print("locked", flush=True)
time.sleep(600)
"""


def is_free(directory: Path) -> bool:
    try:
        acquire_lock(directory).release()
    except LockedError:
        return False
    return True


def test_a_directory_is_locked_until_its_lock_is_released(tmp_path: Path) -> None:
    lock = acquire_lock(tmp_path)
    with pytest.raises(LockedError, match="another process") as caught:
        acquire_lock(tmp_path)
    assert caught.value.source == str(tmp_path)
    lock.release()
    assert is_free(tmp_path)
    assert (tmp_path / LOCK_FILE).exists()


def test_a_killed_process_releases_its_lock(tmp_path: Path) -> None:
    with subprocess.Popen(
        [sys.executable, "-c", HOLDER, tmp_path], stdout=subprocess.PIPE, text=True, env=surroundings()
    ) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "locked\n"
        assert not is_free(tmp_path)
        process.kill()
    assert is_free(tmp_path)


def test_a_directory_that_cannot_have_a_lock_is_named(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(InputError) as caught:
        acquire_lock(tmp_path / "file")
    assert caught.value.source == str(tmp_path / "file")
    assert not isinstance(caught.value, LockedError)


def test_a_lock_is_held_during_a_block(tmp_path: Path) -> None:
    with locked(tmp_path):
        assert not is_free(tmp_path)
    assert is_free(tmp_path)


def test_a_block_that_fails_releases_its_lock(tmp_path: Path) -> None:
    with pytest.raises(ZeroDivisionError), locked(tmp_path):
        raise ZeroDivisionError
    assert is_free(tmp_path)


def test_a_lock_to_keep_is_released_only_on_an_error(tmp_path: Path) -> None:
    lock = acquire_lock(tmp_path)
    with released_on_error(lock):
        pass
    assert not is_free(tmp_path)
    with pytest.raises(KeyboardInterrupt), released_on_error(lock):
        raise KeyboardInterrupt
    assert is_free(tmp_path)


def test_a_waiting_thread_acquires_the_lock_after_its_release(tmp_path: Path) -> None:
    order: list[str] = []
    has_begun = threading.Event()

    def second() -> None:
        has_begun.set()
        with locked_after_others(tmp_path / "a.lock"):
            order.append("second")

    thread = threading.Thread(target=second)
    with locked_after_others(tmp_path / "a.lock"):
        thread.start()
        assert has_begun.wait(LIMIT)
        thread.join(0.2)
        order.append("first")
    thread.join(LIMIT)
    assert order == ["first", "second"]


def test_a_lock_that_cannot_be_written_is_named(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    path = tmp_path / "file" / "a.lock"
    with pytest.raises(InputError) as caught, locked_after_others(path):
        pass
    assert caught.value.source == str(path)
