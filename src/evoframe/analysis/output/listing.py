"""Which files a report consists of: the next one in its place removes those that it does not have."""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Iterable, Mapping
from pathlib import Path

from evoframe.analysis.output.writing import write_files
from evoframe.errors import InputError, RunError
from evoframe.files import LARGEST_DOCUMENT, is_file, read_text

__all__ = ["LIST_FILE", "listed", "settle"]

LIST_FILE = "report.json"
"""In a report's directory: ``files``, the name of each of its other files -> its SHA-256."""


def listed(directory: Path) -> dict[str, str]:
    """Return the files of the report that is there: name -> SHA-256; nothing if there is none.

    Raises:
        InputError: There is a file of that name that is no list of a report's files.
    """
    path = directory / LIST_FILE
    if not is_file(path):
        return {}
    try:
        files = json.loads(read_text(path, LARGEST_DOCUMENT))["files"].items()
        if not all(re.fullmatch(r"[^/\0]+", name) and name not in {".", ".."} for name, _ in files):
            raise ValueError("a file of another directory")  # noqa: TRY301 - as all others
    except (AttributeError, ValueError, TypeError, KeyError, RecursionError) as error:
        raise InputError(
            f"{path}: is no list of a report's files; remove it, or choose another place with --out"
        ) from error
    return {name: str(digest) for name, digest in files}


def settle(directory: Path, before: Mapping[str, str], files: Iterable[Path]) -> Path:
    """Remove the files of an earlier report that were not written again, and list those of this one.

    A file that somebody has changed since is not the report's any more, and stays.

    Args:
        directory: Of the report.
        before: What :func:`listed` said before it was written.
        files: What was written.

    Returns:
        The list.

    Raises:
        RunError: A file cannot be removed, or the list not be written.
    """
    now = {path.name: _digest(path) for path in files}
    kept = {name.casefold() for name in now}  # some file systems know no capitals
    for name, digest in before.items():
        if name.casefold() not in kept:
            _remove(directory / name, digest)
    text = json.dumps({"files": dict(sorted(now.items()))}, indent=1)
    [path] = write_files({LIST_FILE: f"{text}\n".encode()}, directory)
    return path


def _remove(path: Path, digest: str) -> None:
    """Remove a file that still has the content that we wrote."""
    try:
        if path.is_file() and not path.is_symlink() and _digest(path) == digest:
            path.unlink()
    except OSError as error:
        raise RunError(f"{path}: cannot be removed: {error.strerror}") from error


def _digest(path: Path) -> str:
    try:
        return hashlib.sha256(path.read_bytes()).hexdigest()
    except OSError as error:
        raise RunError(f"{path}: cannot be read: {error.strerror}") from error
