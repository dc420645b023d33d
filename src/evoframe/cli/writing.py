"""Writing of a command's output to a path given by the user."""

from __future__ import annotations

from pathlib import Path

from evoframe.cli.streams import echo, lend_descriptor
from evoframe.errors import InputError, RunError
from evoframe.files import write_atomically

__all__ = ["STDOUT", "write_file"]

STDOUT = Path("-")


@lend_descriptor()  # for a path such as /dev/stdout
def write_file(path: Path, data: bytes, *, force: bool) -> None:
    """Write a file, or standard output for :data:`STDOUT`; overwrite different content only with *force*.

    Raises:
        InputError: The file cannot be written, or exists with different content.
    """
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
            write_atomically(path, data)
    except OSError as error:
        raise InputError(f"cannot be written: {error.strerror}", source=path) from error
    except RunError as error:
        raise InputError(error.problem, source=error.source, key=error.key) from error
