"""Writing of a command's output to a path given by the user, without overwriting anything unasked."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any, TypeVar

import click

from evoframe.cli.context import modules_of
from evoframe.cli.streams import echo, lend_descriptor
from evoframe.config import Layers
from evoframe.errors import InputError, RunError
from evoframe.files import write_atomically

__all__ = ["STDOUT", "files_of_settings", "force_option", "refuse_inputs", "write_file"]

F = TypeVar("F", bound=Callable[..., Any])

STDOUT = Path("-")


def force_option(function: F) -> F:
    """Add ``--force`` to a command that writes a file."""
    return click.option("--force", is_flag=True, help="Overwrite a file with different content.")(function)


def files_of_settings(ctx: click.Context, preset: Layers | None) -> Iterator[Path]:
    """Yield the files from which a command takes its settings and local plugins.

    Args:
        ctx: The context of the command.
        preset: The settings of a preset or TOML file, which may extend others; ``None`` for none.
    """
    if preset is not None:
        yield from (Path(layer.origin) for layer in preset.layers)
    for module in modules_of(ctx):
        file = module if module.endswith(".py") else getattr(sys.modules.get(module), "__file__", None)
        if file is not None:
            yield Path(file)


@lend_descriptor()  # for a path such as /dev/stdout
def refuse_inputs(path: Path, inputs: Iterable[Path]) -> None:
    """Refuse to overwrite a file that the command reads, whatever the spelling of its path.

    Args:
        path: The file to write.
        inputs: Files that the command reads; they need not exist.

    Raises:
        InputError: *path* is one of them, possibly through links.
    """
    for each in inputs:
        if _is_same_file(path, each):
            raise InputError(f"is an input of this command ({each}); choose another name", source=path)


@lend_descriptor()
def write_file(path: Path, data: bytes, *, force: bool, inputs: Iterable[Path] = ()) -> None:
    """Write a file, or standard output for :data:`STDOUT`; overwrite different content only with *force*.

    Args:
        path: The file to write.
        data: Its content.
        force: Whether to overwrite a file with different content.
        inputs: Files that the command reads, which are never overwritten.

    Raises:
        InputError: The file cannot be written, is one of *inputs*, or exists with different content.
    """
    refuse_inputs(path, inputs)
    try:
        if path == STDOUT:
            echo(data, nl=False)
        elif path.exists() and not path.is_file():
            path.write_bytes(data)  # a device or a pipe; fails for a directory
        elif not path.exists() or path.read_bytes() != data:
            if path.exists() and not force:
                raise InputError(
                    "exists with different content; overwrite it with --force, or choose another name",
                    source=path,
                )
            target = Path(os.path.realpath(path))  # a link remains, and leads to the file
            if target.is_symlink():
                raise InputError("is a link that leads to itself", source=path)
            write_atomically(target, data)
    except OSError as error:
        raise InputError(f"cannot be written: {error.strerror}", source=path) from error
    except RunError as error:
        raise InputError(error.problem, source=path) from error


def _is_same_file(path: Path, other: Path) -> bool:
    """Return whether two paths lead to the same regular file; devices and pipes may be read and written."""
    try:
        return path.is_file() and path.samefile(other)
    except (OSError, ValueError):  # one of them is missing, so there is nothing to overwrite
        return False
