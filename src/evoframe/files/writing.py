"""Writing of files: atomically, and JSON always in the same form."""

from __future__ import annotations

import contextlib
import json
import os
from pathlib import Path
from typing import Any

from evoframe.errors import RunError

__all__ = ["is_leftover", "json_text", "remove", "write_atomically", "write_json"]

_UNFINISHED = ".new"


def write_json(path: Path, document: Any) -> None:
    """Write JSON as :func:`write_atomically` does, always in the same way."""
    write_atomically(path, f"{json_text(document)}\n".encode())


def write_atomically(path: Path, data: bytes) -> None:
    """Write a file so that a reader sees the old one or the new one, never a part.

    Raises:
        RunError: It cannot be written.
    """
    temporary = path.with_name(f".{path.name}{_UNFINISHED}")
    try:
        with temporary.open("wb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        temporary.replace(path)
    except OSError as error:
        with contextlib.suppress(OSError):  # the first error is the one to tell
            temporary.unlink(missing_ok=True)
        raise RunError(f"{path}: cannot be written: {error.strerror}") from error


# What contains itself ends in a RecursionError.
_encode = json.JSONEncoder(separators=(",", ":"), allow_nan=False, check_circular=False).encode


def json_text(document: Any) -> str:
    """Return JSON values as compact text, the same for the same values.

    Raises:
        TypeError: It has a value that JSON has not.
        ValueError: It has a number that is not finite.
        RecursionError: It contains itself, or is nested too deeply.
    """
    return _encode(document)


def is_leftover(path: Path) -> bool:
    """Return whether this is what a kill has left of the writing of a file."""
    return path.name.startswith(".") and path.name.endswith(_UNFINISHED)


def remove(path: Path) -> None:
    """Remove a file, if it is there.

    Raises:
        RunError: It cannot be removed.
    """
    try:
        path.unlink(missing_ok=True)
    except OSError as error:
        raise RunError(f"{path}: cannot be removed: {error.strerror}") from error
