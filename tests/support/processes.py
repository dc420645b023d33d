"""Programs in processes of their own, as a person starts them."""

from __future__ import annotations

import contextlib
import os
import pty
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

Evoframe = Callable[..., subprocess.CompletedProcess[str]]
"""Takes the arguments of ``evoframe``, and changes to the environment as keyword arguments."""


_OF_THE_TERMINAL = ("FORCE_COLOR", "NO_COLOR", "COLUMNS", "LINES", "TTY_COMPATIBLE", "TTY_INTERACTIVE")


def surroundings() -> dict[str, str]:
    """Return the environment without what would change what a program shows."""
    kept = {key: value for key, value in os.environ.items() if not key.startswith("EVOFRAME_")}
    return {key: value for key, value in kept.items() if key not in _OF_THE_TERMINAL}


def python(
    *arguments: object, directory: Path | None = None, **environment: str
) -> subprocess.CompletedProcess[str]:
    """Run this Python with changes to the environment; whether it failed is for the caller to see."""
    return subprocess.run(
        [sys.executable, *map(str, arguments)],
        cwd=directory,
        env={**surroundings(), **environment},
        capture_output=True,
        text=True,
        check=False,
    )


@contextlib.contextmanager
def started(directory: Path, *arguments: object) -> Iterator[subprocess.Popen[str]]:
    """Start the program in the background; end it if the test does not."""
    with subprocess.Popen(
        [sys.executable, "-m", "evoframe", *map(str, arguments)],
        cwd=directory,
        env=surroundings(),
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        try:
            yield process
        finally:
            process.kill()


def told(process: subprocess.Popen[str], words: str) -> str:
    """Read what a program says up to the line with these *words*, and return that line."""
    assert process.stderr is not None
    said = []
    for line in process.stderr:
        said.append(line)
        if words in line:
            return line
    raise AssertionError(f"the program ended without {words!r}: {said}")


def on_a_terminal(arguments: list[str], directory: Path, *, lines: int = 24) -> str:
    """Return all that a person at a terminal of 80 columns is sent."""
    pid, terminal = pty.fork()
    if pid == 0:
        os.chdir(directory)
        terminal_of = {**surroundings(), "TERM": "xterm-256color", "COLUMNS": "80", "LINES": str(lines)}
        command = [sys.executable, "-m", "evoframe", *arguments]
        os.execve(sys.executable, command, terminal_of)  # noqa: S606 - the program under test
    shown = b""
    with contextlib.suppress(OSError):  # what a terminal reads once its program has ended
        while part := os.read(terminal, 65536):
            shown += part
    assert os.waitpid(pid, 0)[1] == 0, shown
    return shown.decode()
