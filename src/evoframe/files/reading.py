"""Files that may come from anyone: read whole, but only if they are files, and not endless."""

from __future__ import annotations

import json
import stat
import tomllib
from pathlib import Path
from typing import Any

from evoframe.errors import EvoframeError, InputError

__all__ = [
    "LARGEST_DOCUMENT",
    "is_directory",
    "is_file",
    "parsed_json",
    "parsed_toml",
    "read_text",
    "refuse_links",
    "shown_name",
]

LARGEST_DOCUMENT = 64
"""MiB; a design or a state of this size is none of ours."""


def read_text(path: Path, largest: int) -> str:
    """Return the text of a file.

    Args:
        path: The file.
        largest: How many MiB it may have.

    Raises:
        InputError: It cannot be read, is too large, or is no text.
    """
    try:
        with path.open("rb") as file:
            content = file.read((largest << 20) + 1)
        if len(content) > largest << 20:
            raise InputError(f"{path}: is larger than {largest} MiB, which none of ours is")
        return content.decode("utf-8")
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: is not UTF-8 text") from error
    except ValueError as error:  # a name that no file can have
        raise InputError(f"{str(path)!r}: cannot be read: {error}") from error


def parsed_json(text: str) -> Any:
    """Return what a file from anyone holds.

    Raises:
        ValueError: It is not valid JSON.
    """
    try:
        return json.loads(text)
    except (ValueError, RecursionError) as error:
        raise ValueError(f"not valid JSON: {error}") from error


def parsed_toml(text: str, origin: str, error_type: type[EvoframeError] = InputError) -> dict[str, Any]:
    """Return the tables of a TOML file from anyone.

    Args:
        text: Its text.
        origin: The name of the file in messages.
        error_type: Type of the error.

    Raises:
        EvoframeError: It is not valid TOML; of the given type.
    """
    try:
        return tomllib.loads(text)
    except (ValueError, RecursionError) as error:  # a number of thousands of digits is a plain ValueError
        raise error_type(f"{origin}: not valid TOML: {error}") from error


def is_directory(path: Path) -> bool:
    """Return whether there is a directory.

    Raises:
        InputError: There is nothing, or it cannot be looked at.
    """
    return stat.S_ISDIR(_looked_at(path))


def is_file(path: Path) -> bool:
    """Return whether there is a file; not if there is nothing.

    Raises:
        InputError: It cannot be looked at.
    """
    try:
        return stat.S_ISREG(_looked_at(path))
    except InputError as error:
        if isinstance(error.__cause__, FileNotFoundError | NotADirectoryError):
            return False
        raise


def _looked_at(path: Path) -> int:
    try:
        return path.stat().st_mode
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from error
    except ValueError as error:  # a name that no file can have
        raise InputError(f"{str(path)!r}: cannot be read: {error}") from error


def shown_name(path: Path) -> str:
    """Return what a directory is called in a title, however a person named it: text that can be written."""
    return path.resolve().name.encode("utf-8", "replace").decode()


def refuse_links(directory: Path) -> None:
    """Make sure that what lies in a run's directory is there, and not elsewhere.

    Raises:
        InputError: There is a link, or something that is neither a file nor a directory.
    """
    try:
        for path in directory.iterdir():
            mode = _mode(path)
            if not (stat.S_ISREG(mode) or stat.S_ISDIR(mode)):
                what = "a link" if stat.S_ISLNK(mode) else "no file"
                raise InputError(f"{path}: is {what}; a run's directory has nothing but files")
    except FileNotFoundError:
        return  # no directory: whoever reads it says so
    except OSError as error:
        raise InputError(f"{directory}: cannot be read: {error.strerror}") from error


def _mode(path: Path) -> int:
    try:
        return path.lstat().st_mode
    except FileNotFoundError:  # a journal that has just gone
        return stat.S_IFREG
