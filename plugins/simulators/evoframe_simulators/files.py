"""Errors in files given by the user, with the name of the file."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from evoframe import InputError

__all__ = ["naming_source"]


@contextmanager
def naming_source(path: Path) -> Iterator[None]:
    """Name *path* as the source of input errors raised in the block.

    Raises:
        InputError: The block raised one, or the file could not be read; its ``source`` is *path*.
    """
    try:
        yield
    except OSError as error:
        raise InputError(f"cannot be read: {error.strerror or error}", source=path) from error
    except InputError as error:
        raise InputError(error.problem, source=path, key=error.key) from error
