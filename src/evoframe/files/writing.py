"""Atomic writing of files, and JSON in one canonical form."""

from __future__ import annotations

import contextlib
import json
import os
from pathlib import Path
from typing import Any

from evoframe.errors import RunError
from evoframe.files.reading import TOO_DEEP, is_too_deep

__all__ = ["is_leftover", "json_text", "remove", "write_atomically", "write_json"]

_UNFINISHED = ".new"


def write_json(path: Path, document: Any) -> None:
    """Write JSON atomically; equal documents give equal bytes."""
    write_atomically(path, f"{json_text(document)}\n".encode())


def write_atomically(path: Path, data: bytes) -> None:
    """Write a file so that readers see either the old or the new content, never a part.

    Raises:
        RunError: The file cannot be written.
    """
    temporary = path.with_name(f".{path.name}{_UNFINISHED}")
    try:
        temporary.unlink(missing_ok=True)  # of a killed process; a link in its place must not be followed
        with temporary.open("xb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        temporary.replace(path)
    except OSError as error:
        with contextlib.suppress(OSError):  # the first error is the one to report
            temporary.unlink(missing_ok=True)
        raise RunError(f"cannot be written: {error.strerror}", source=path) from error


# The check for values that contain themselves takes time, and is_too_deep() finds them.
_encode = json.JSONEncoder(separators=(",", ":"), allow_nan=False, check_circular=False).encode


def json_text(document: Any) -> str:
    """Return JSON values as compact text; equal values give equal text.

    Raises:
        TypeError: The document contains a value that JSON cannot represent.
        ValueError: The document contains a number that is not finite, contains itself, or is nested deeper
            than can be read back.
    """
    if is_too_deep(document):
        raise ValueError(TOO_DEEP)
    return _encode(document)


def is_leftover(path: Path) -> bool:
    """Return whether *path* is a temporary file left by a killed process."""
    return path.name.startswith(".") and path.name.endswith(_UNFINISHED)


def remove(path: Path) -> None:
    """Remove a file, if it exists.

    Raises:
        RunError: The file cannot be removed.
    """
    try:
        path.unlink(missing_ok=True)
    except OSError as error:
        raise RunError(f"cannot be removed: {error.strerror}", source=path) from error
