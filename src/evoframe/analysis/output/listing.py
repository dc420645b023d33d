"""List of the files of a report, which the next report in the same directory may overwrite or remove."""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import attrs

from evoframe.analysis.output.writing import write_files
from evoframe.errors import InputError, RunError
from evoframe.files import LARGEST_DOCUMENT, is_file, parsed_json, read_text

__all__ = ["LIST_FILE", "Listing", "announce", "listed", "refuse_overwriting", "settle"]

LIST_FILE = "report.json"
"""File in a report's directory with ``of``: digest of the run or study, and ``files``: name of each other
file of the report -> its SHA-256. While a report is written, ``earlier`` has those of the report before."""


@attrs.frozen
class Listing:
    """The files of the report in a directory.

    Attributes:
        of: Digest of the run or study; empty if unknown.
        files: Name -> SHA-256 of each content that evoframe has written; empty if there is no report.
    """

    of: str = ""
    files: Mapping[str, frozenset[str]] = attrs.field(factory=dict)


def listed(directory: Path) -> Listing:
    """Return the list of the report in *directory*.

    Raises:
        InputError: The file :data:`LIST_FILE` exists, but is not a list of a report's files.
    """
    path = directory / LIST_FILE
    if not is_file(path):
        return Listing()
    try:
        document = parsed_json(read_text(path, LARGEST_DOCUMENT))
        files = {name: {str(digest)} for name, digest in document["files"].items()}
        for name, digests in document.get("earlier", {}).items():
            files.setdefault(name, set()).update(map(str, digests))
        if not all(re.fullmatch(r"[^/\0]+", name) and name not in {".", ".."} for name in files):
            raise ValueError("a file outside of the directory")  # noqa: TRY301 - handled as the others
    except (AttributeError, ValueError, TypeError, KeyError) as error:
        raise InputError(
            "is not a list of a report's files; remove it, or choose another directory with --out",
            source=path,
        ) from error
    known = {name: frozenset(digests) for name, digests in files.items()}
    return Listing(str(document.get("of", "")), known)


def refuse_overwriting(directory: Path, files: Mapping[str, bytes], before: Listing) -> None:
    """Check that each file to write is missing, or was written by evoframe and not modified since.

    Args:
        directory: Directory of the report.
        files: Name -> bytes of the new files.
        before: The list of the earlier report there.

    Raises:
        InputError: A file would be overwritten.
        RunError: A file cannot be read.
    """
    for name, data in files.items():
        path = directory / name
        allowed = {*before.files.get(name, ()), hashlib.sha256(data).hexdigest()}
        if path.exists() and (not path.is_file() or _digest(path) not in allowed):
            raise InputError(
                "was not written by evoframe, or was modified since; overwrite it with --force, or choose "
                "another directory with --out",
                source=path,
            )


def announce(directory: Path, of: str, files: Mapping[str, bytes], before: Listing) -> None:
    """List the files that are going to be written, so that they are known even if writing is interrupted.

    Args:
        directory: Directory of the report.
        of: Digest of the run or study.
        files: Name -> bytes of the new files.
        before: The list of the earlier report there.

    Raises:
        RunError: The list cannot be written.
    """
    now = {name: hashlib.sha256(data).hexdigest() for name, data in files.items()}
    earlier = {name: sorted(digests) for name, digests in before.files.items()}
    _write(directory, {"of": of, "files": now, "earlier": earlier})


def settle(directory: Path, of: str, before: Listing, files: Iterable[Path]) -> Path:
    """Remove the files of an earlier report that this one does not overwrite, and list the files of this one.

    A file that was modified since the earlier report is kept.

    Args:
        directory: Directory of the report.
        of: Digest of the run or study.
        before: Result of :func:`listed` before the report was written.
        files: Files of the new report.

    Returns:
        Path of the list.

    Raises:
        RunError: A file cannot be removed, or the list cannot be written.
    """
    now = {path.name: _digest(path) for path in files}
    kept = {name.casefold() for name in now}  # some file systems ignore case
    for name, digests in before.files.items():
        if name.casefold() not in kept:
            _remove(directory / name, digests)
    return _write(directory, {"of": of, "files": now})


def _write(directory: Path, document: Mapping[str, Any]) -> Path:
    text = json.dumps(document, indent=1, sort_keys=True)
    [path] = write_files({LIST_FILE: f"{text}\n".encode()}, directory)
    return path


def _remove(path: Path, digests: Iterable[str]) -> None:
    """Remove a file if its content is still one of an earlier report."""
    try:
        if path.is_file() and not path.is_symlink() and _digest(path) in digests:
            path.unlink()
    except OSError as error:
        raise RunError(f"cannot be removed: {error.strerror}", source=path) from error


def _digest(path: Path) -> str:
    try:
        return hashlib.sha256(path.read_bytes()).hexdigest()
    except OSError as error:
        raise RunError(f"cannot be read: {error.strerror}", source=path) from error
