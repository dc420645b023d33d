"""Reading of untrusted files: regular files only, up to a maximum size."""

from __future__ import annotations

import codecs
import json
import os
import re
import stat
import tomllib
from collections.abc import Iterable, Mapping
from itertools import chain
from pathlib import Path
from typing import Any

from evoframe.errors import EvoframeError, InputError

__all__ = [
    "DEEPEST",
    "LARGEST_DOCUMENT",
    "TOO_DEEP",
    "encodable",
    "exists",
    "is_directory",
    "is_file",
    "is_too_deep",
    "parsed_json",
    "parsed_toml",
    "read_text",
    "refuse_links",
    "shown_name",
]

LARGEST_DOCUMENT = 64
"""Maximum size of a design or of a saved state, MiB; real ones are far smaller."""

DEEPEST = 64
"""Maximum number of lists and tables inside each other, in every document; evoframe's own have at most 8.

Functions that recurse into a document need a few frames for each, of the thousand that Python has.
"""

TOO_DEEP = f"lists and tables are nested more than {DEEPEST} deep"
"""The problem of a document that :func:`is_too_deep`."""

_NESTINGS = (dict, list, tuple)
_SCALARS = frozenset({bool, float, int, str, type(None)})

_KEY = r"""(?:[A-Za-z0-9_-]++|"[^"\n]*+"|'[^'\n]*+')"""
_DEEP_KEY = re.compile(rf"(?<![A-Za-z0-9_-]){_KEY}(?:[ \t]*+\.[ \t]*+{_KEY}){{{DEEPEST}}}")


def read_text(path: Path, largest: int) -> str:
    """Return the text of a file, without a byte order mark; line ends remain.

    Args:
        path: The file.
        largest: Maximum size, MiB.

    Raises:
        InputError: The file cannot be read, is too large, or is not UTF-8 text.
    """
    try:
        with open(path, "rb", opener=_open_without_waiting) as file:
            content = file.read((largest << 20) + 1)
            if not content and stat.S_ISFIFO(os.fstat(file.fileno()).st_mode):
                raise InputError("is a pipe, and nothing was written to it", source=path)
        if len(content) > largest << 20:
            raise InputError(f"exceeds {largest} MiB", source=path)
        if encoding := _another_encoding(content):
            raise InputError(f"is {encoding} text; save it as UTF-8", source=path)
        return content.decode("utf-8-sig")  # Windows programs begin a file with a byte order mark
    except UnicodeDecodeError as error:
        raise InputError("is not UTF-8 text; save it as UTF-8", source=path) from error
    except (OSError, ValueError) as error:
        raise _unreadable(path, error) from error


def _open_without_waiting(path: str, flags: int) -> int:
    """Open a file; a named pipe that no program writes to seems empty, instead of waiting for ever."""
    descriptor = os.open(path, flags | os.O_NONBLOCK)
    os.set_blocking(descriptor, True)
    return descriptor


_SURROGATE = re.compile(r"\\u[dD][89a-fA-F]")

_MARKS = {  # the longer first: the shorter begins it
    codecs.BOM_UTF32_LE: "UTF-32",
    codecs.BOM_UTF32_BE: "UTF-32",
    codecs.BOM_UTF16_LE: "UTF-16",
    codecs.BOM_UTF16_BE: "UTF-16",
}
_ZEROS: Mapping[tuple[bool, ...], str] = {
    (True, True, True, False): "UTF-32",
    (False, True, True, True): "UTF-32",
    (True, False, True, False): "UTF-16",
    (False, True, False, True): "UTF-16",
}
"""Which of the first four bytes are zero in ASCII characters without a mark, as in section 3 of RFC 4627."""


def _another_encoding(content: bytes) -> str | None:
    """Return the name of an encoding other than UTF-8 that a text has for certain."""
    for mark, name in _MARKS.items():
        if content.startswith(mark):
            return name
    return _ZEROS.get(tuple(byte == 0 for byte in content[:4]))


def parsed_json(text: str) -> Any:
    """Return the value of an untrusted JSON text.

    Raises:
        ValueError: The text is not valid JSON, or is nested deeper than :data:`DEEPEST`.
    """
    try:
        document = json.loads(text)
        if _SURROGATE.search(text):  # half a character, which no file that evoframe writes can contain
            json.dumps(document, ensure_ascii=False).encode()
    except ValueError as error:
        raise ValueError(f"not valid JSON: {error}") from error
    except RecursionError as error:
        raise ValueError(TOO_DEEP) from error
    if is_too_deep(document):
        raise ValueError(TOO_DEEP)
    return document


def parsed_toml(text: str, origin: str, error_type: type[EvoframeError] = InputError) -> dict[str, Any]:
    """Return the tables of an untrusted TOML text.

    Args:
        text: The text.
        origin: The source named in errors: a file or an option.
        error_type: Type of the error.

    Raises:
        EvoframeError: The text is not valid TOML, or is nested deeper than :data:`DEEPEST`; of the given
            type.
    """
    if _DEEP_KEY.search(text):  # tomllib takes quadratic time for a dotted key
        raise error_type(TOO_DEEP, source=origin)
    if "\n" not in text:  # the line ends of old Macs, which TOML does not know
        text = text.replace("\r", "\n")
    try:
        text.encode()  # fails for a name of a file that is not UTF-8, given as a setting
        tables = tomllib.loads(text)
    except ValueError as error:  # also for a number of thousands of digits
        raise error_type(f"not valid TOML: {error}", source=origin) from error
    except RecursionError as error:
        raise error_type(TOO_DEEP, source=origin) from error
    if is_too_deep(tables):
        raise error_type(TOO_DEEP, source=origin)
    return tables


def is_too_deep(document: Any) -> bool:
    """Return whether lists and tables are nested deeper than :data:`DEEPEST`, or contain themselves."""
    level = _nested([document])
    for _ in range(DEEPEST):
        if not level:
            return False
        level = _nested(chain.from_iterable(map(_values, level)))
    return bool(level)


def _values(nesting: Any) -> Iterable[Any]:
    return nesting.values() if isinstance(nesting, dict) else nesting


def _nested(values: Iterable[Any]) -> list[Any]:
    """Return the lists and tables among *values*; one that is shared counts once."""
    # Most values are scalars, whose exact types are the fastest to recognize.
    nested = {id(v): v for v in values if type(v) not in _SCALARS and isinstance(v, _NESTINGS)}
    return list(nested.values())


def is_directory(path: Path) -> bool:
    """Return whether *path* is a directory.

    Raises:
        InputError: The path does not exist or cannot be accessed.
    """
    return stat.S_ISDIR(_mode(path))


def is_file(path: Path) -> bool:
    """Return whether *path* is a regular file; false if it does not exist.

    Raises:
        InputError: The path cannot be accessed.
    """
    return exists(path) and stat.S_ISREG(_mode(path))


def exists(path: Path) -> bool:
    """Return whether *path* exists.

    Raises:
        InputError: The path cannot be accessed.
    """
    try:
        _mode(path)
    except InputError as error:
        if isinstance(error.__cause__, FileNotFoundError | NotADirectoryError):
            return False
        raise
    return True


def _mode(path: Path) -> int:
    try:
        return path.stat().st_mode
    except (OSError, ValueError) as error:
        raise _unreadable(path, error) from error


def _unreadable(path: Path, error: OSError | ValueError) -> InputError:
    if isinstance(error, OSError):
        return InputError(f"cannot be read: {error.strerror}", source=path)
    return InputError(f"cannot be read: {error}", source=repr(str(path)))  # a name with a null character


def shown_name(path: Path) -> str:
    """Return the name of a directory for a title; characters that UTF-8 cannot encode become ``?``."""
    return encodable(path.resolve().name)


def encodable(text: str) -> str:
    """Return a text that may contain the name of a file; characters that UTF-8 cannot encode become ``?``."""
    return text.encode("utf-8", "replace").decode()


def refuse_links(directory: Path) -> None:
    """Refuse a run directory with links, which could lead to files elsewhere.

    Raises:
        InputError: The directory contains a link, or something that is neither a file nor a directory.
    """
    try:
        for path in directory.iterdir():
            mode = _own_mode(path)
            if not (stat.S_ISREG(mode) or stat.S_ISDIR(mode)):
                found = "a link" if stat.S_ISLNK(mode) else "not a regular file"
                raise InputError(
                    f"is {found}; a run directory may contain only files and directories", source=path
                )
    except FileNotFoundError:
        return  # the caller reports a missing directory
    except OSError as error:
        raise InputError(f"cannot be read: {error.strerror}", source=directory) from error


def _own_mode(path: Path) -> int:
    try:
        return path.lstat().st_mode
    except FileNotFoundError:  # a journal that SQLite has just removed
        return stat.S_IFREG
