"""List of the files of a report, from which the next report in the same directory removes outdated files."""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Iterable, Mapping
from pathlib import Path

from evoframe.analysis.output.writing import write_files
from evoframe.errors import InputError, RunError
from evoframe.files import LARGEST_DOCUMENT, is_file, parsed_json, read_text

__all__ = ["LIST_FILE", "listed", "settle"]

LIST_FILE = "report.json"
"""File in a report's directory with ``files``: name of each other file of the report -> its SHA-256."""


def listed(directory: Path) -> dict[str, str]:
    """Return the files of the report in *directory*: name -> SHA-256; empty if there is no report.

    Raises:
        InputError: The file :data:`LIST_FILE` exists, but is not a list of a report's files.
    """
    path = directory / LIST_FILE
    if not is_file(path):
        return {}
    try:
        files = parsed_json(read_text(path, LARGEST_DOCUMENT))["files"].items()
        if not all(re.fullmatch(r"[^/\0]+", name) and name not in {".", ".."} for name, _ in files):
            raise ValueError("a file outside of the directory")  # noqa: TRY301 - handled as the others
    except (AttributeError, ValueError, TypeError, KeyError) as error:
        raise InputError(
            "is not a list of a report's files; remove it, or choose another directory with --out",
            source=path,
        ) from error
    return {name: str(digest) for name, digest in files}


def settle(directory: Path, before: Mapping[str, str], files: Iterable[Path]) -> Path:
    """Remove the files of an earlier report that this one does not overwrite, and list the files of this one.

    A file that was modified since the earlier report is kept.

    Args:
        directory: Directory of the report.
        before: Result of :func:`listed` before the report was written.
        files: Files of the new report.

    Returns:
        Path of the list.

    Raises:
        RunError: A file cannot be removed, or the list cannot be written.
    """
    now = {path.name: _digest(path) for path in files}
    kept = {name.casefold() for name in now}  # some file systems ignore case
    for name, digest in before.items():
        if name.casefold() not in kept:
            _remove(directory / name, digest)
    text = json.dumps({"files": dict(sorted(now.items()))}, indent=1)
    [path] = write_files({LIST_FILE: f"{text}\n".encode()}, directory)
    return path


def _remove(path: Path, digest: str) -> None:
    """Remove a file if its content is still that of the earlier report."""
    try:
        if path.is_file() and not path.is_symlink() and _digest(path) == digest:
            path.unlink()
    except OSError as error:
        raise RunError(f"cannot be removed: {error.strerror}", source=path) from error


def _digest(path: Path) -> str:
    try:
        return hashlib.sha256(path.read_bytes()).hexdigest()
    except OSError as error:
        raise RunError(f"cannot be read: {error.strerror}", source=path) from error
