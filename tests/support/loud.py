"""A plugin that prints by all means: on import, in hooks, while it works, and at exit.

With the environment variable ``LOUD=mildly`` it uses only the streams of Python that can be replaced.
"""

# ruff: noqa: T201 - as plugins do while they are written

from __future__ import annotations

import atexit
import ctypes
import logging
import os
import subprocess
import sys
from collections.abc import Mapping, Sequence
from typing import Any

import attrs
import click
import toys

from evoframe import Design, Outcome, Record, hookimpl

_KEPT = sys.stdout
_LIBRARY = ctypes.CDLL(None)


def shout(when: str) -> None:
    """Print a line with each of the means that a plugin has."""
    print(f"print {when} ünd \udcff")
    print(f"kept {when}", file=_KEPT)
    sys.stdout.write(f"write {when}\n")
    sys.stdout.buffer.write(f"buffer {when}\n".encode())
    if os.environ.get("LOUD") == "mildly":
        return
    print(f"original {when}", file=sys.__stdout__, flush=True)
    os.write(1, f"descriptor {when}\n".encode())
    _LIBRARY.printf(f"libc {when}\n".encode())  # remains in libc's buffer until the process ends
    subprocess.run([sys.executable, "-c", f"print('child {when}')"], check=True)
    click.echo(f"click {when}")


shout("import")
logging.getLogger("loud").addHandler(logging.StreamHandler(sys.stdout))
atexit.register(shout, "exit")


@attrs.frozen
class Loud(toys.Steered):
    """Prints while it simulates, and in the other methods that commands call."""

    def simulate(self, designs: Sequence[Design], record: Record) -> Sequence[Outcome]:
        shout("simulate")
        return super().simulate(designs, record)

    def check(self, record: Record) -> None:
        print("print check")
        super().check(record)


@hookimpl
def evoframe_simulators() -> Mapping[str, type[Any]]:
    shout("hook")
    return {"loud": Loud}


@hookimpl
def evoframe_turn_finished() -> None:
    print("print turn")


@hookimpl
def evoframe_commands(cli: click.Group) -> None:
    print("print commands")

    @cli.command()
    def greet() -> None:
        click.echo("hello")
        subprocess.run([sys.executable, "-c", "print('from a child')"], check=True)
