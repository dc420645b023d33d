"""Standard output for the requested output only: whatever plugins print goes to standard error."""

from __future__ import annotations

import contextlib
import errno
import os
import signal
import sys
from collections.abc import Iterator
from contextvars import ContextVar
from typing import TextIO

import click

from evoframe.cli.signals import exit_code
from evoframe.streams import StandardStream, make_unfailing, open_missing

__all__ = [
    "divert_plugin_text",
    "echo",
    "finish_streams",
    "lend_descriptor",
    "prepare_streams",
    "requested_output",
    "restore_descriptor",
]

_STDOUT, _STDERR = 1, 2

_requested: ContextVar[TextIO | None] = ContextVar("requested output", default=None)


def prepare_streams() -> None:
    """Prepare the streams of this process: none of them raises, and descriptor 1 becomes standard error.

    Text that C code and worker processes print goes there; standard output has a descriptor of its own,
    which other processes do not inherit.
    """
    open_missing()
    make_unfailing(os.dup)
    os.dup2(_STDERR, _STDOUT)


@contextlib.contextmanager
def divert_plugin_text() -> Iterator[None]:
    """Send what is printed in the block to standard error, except through :func:`requested_output`."""
    token = _requested.set(requested_output())
    try:
        with contextlib.redirect_stdout(sys.stderr):
            yield
    finally:
        _requested.reset(token)


def requested_output() -> TextIO:
    """Return the stream for the output that the user requested."""
    return _requested.get() or sys.stdout


def echo(message: object, *, nl: bool = True) -> None:
    """Print a part of the requested output."""
    click.echo(message, file=requested_output(), nl=nl)


def restore_descriptor() -> None:
    """Make descriptor 1 standard output again, for a command of a plugin, whose output is its own."""
    stdout = requested_output()
    if isinstance(stdout, StandardStream):
        stdout.lend(_STDOUT)


@contextlib.contextmanager
def lend_descriptor() -> Iterator[None]:
    """Make descriptor 1 standard output in the block, for files such as ``/dev/stdout``."""
    stdout = requested_output()
    if not isinstance(stdout, StandardStream):
        yield
        return
    previous = os.dup(_STDOUT)
    stdout.lend(_STDOUT)
    try:
        yield
    finally:
        os.dup2(previous, _STDOUT)
        os.close(previous)


def finish_streams() -> int:
    """Close standard output, and report a loss of the requested output.

    Returns:
        The exit code: 0 if nothing was lost; that of a broken pipe, which is not reported; or 1.
    """
    stdout = sys.stdout
    sys.stdout = sys.stderr  # for what plugins print at exit
    if not isinstance(stdout, StandardStream):
        return 0
    stdout.finish()
    if stdout.failure is None:
        return 0
    if stdout.failure.errno == errno.EPIPE:
        return exit_code(getattr(signal, "SIGPIPE", 13))
    cause = stdout.failure.strerror
    click.echo(f"Error: standard output cannot be written: {cause}; the rest of the output is lost", err=True)
    return 1
