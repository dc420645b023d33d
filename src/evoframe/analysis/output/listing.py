"""Which files a report consists of: the next one in its place removes those that it does not have."""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Iterable, Mapping
from pathlib import Path

from evoframe.analysis.output.writing import write_bytes
from evoframe.errors import InputError, RunError
from evoframe.files.reading import LARGEST_DOCUMENT, is_file, read_text

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
        files = json.loads(read_text(path, LARGEST_DOCUMENT))["files"]
    except (ValueError, TypeError, KeyError, RecursionError) as error:
        raise _no_list(path) from error
    if not isinstance(files, dict) or not all(map(_is_name, files)):
        raise _no_list(path)
    return {name: str(digest) for name, digest in files.items()}


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
    return write_bytes(f"{text}\n".encode(), directory / LIST_FILE)


def _is_name(name: str) -> bool:
    """Return whether it can be a file of the directory itself."""
    return re.fullmatch(r"[^/\0]+", name) is not None and name not in {".", ".."}


def _no_list(path: Path) -> InputError:
    return InputError(
        f"{path}: is no list of a report's files; remove it, or choose another place with --out"
    )


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
