"""Programs in separate processes, as users start them."""

from __future__ import annotations

import contextlib
import os
import pty
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

Evoframe = Callable[..., subprocess.CompletedProcess[str]]
"""Takes the arguments of ``evoframe``, and changes to the environment as keyword arguments."""


_OF_THE_TERMINAL = ("FORCE_COLOR", "NO_COLOR", "COLUMNS", "LINES", "TTY_COMPATIBLE", "TTY_INTERACTIVE")


def surroundings() -> dict[str, str]:
    """Return the environment without variables that change the output of a program."""
    kept = {key: value for key, value in os.environ.items() if not key.startswith("EVOFRAME_")}
    return {key: value for key, value in kept.items() if key not in _OF_THE_TERMINAL}


def python(
    *arguments: object, directory: Path | None = None, **environment: str
) -> subprocess.CompletedProcess[str]:
    """Run this Python with changes to the environment; the caller checks the exit code."""
    return subprocess.run(
        [sys.executable, *map(str, arguments)],
        cwd=directory,
        env={**surroundings(), **environment},
        capture_output=True,
        text=True,
        check=False,
    )


def eventually(condition: Callable[[], object], failure: str, limit: float = 120.0) -> None:
    """Wait until a condition holds; the limit, in s, only ends a test that has failed."""
    until = time.monotonic() + limit
    while not condition():
        assert time.monotonic() < until, failure
        time.sleep(0.01)


def is_ended(process: int) -> bool:
    """Return whether a process has ended; a zombie has."""
    try:
        state = Path(f"/proc/{process}/stat").read_text()
    except OSError:
        return True
    return state.rpartition(")")[2].split()[0] == "Z"


@contextlib.contextmanager
def started(directory: Path, *arguments: object) -> Iterator[subprocess.Popen[str]]:
    """Start the program in the background; kill it at the end of the block."""
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
    """Read the standard error of a program up to a line that contains *words*; return that line."""
    assert process.stderr is not None
    lines = []
    for line in process.stderr:
        lines.append(line)
        if words in line:
            return line
    raise AssertionError(f"the program ended without {words!r}: {lines}")


def on_a_terminal(arguments: list[str], directory: Path, *, lines: int = 24) -> str:
    """Return the output of the program on a terminal of 80 columns."""
    pid, terminal = pty.fork()
    if pid == 0:
        os.chdir(directory)
        terminal_of = {**surroundings(), "TERM": "xterm-256color", "COLUMNS": "80", "LINES": str(lines)}
        command = [sys.executable, "-m", "evoframe", *arguments]
        os.execve(sys.executable, command, terminal_of)  # noqa: S606 - the program under test
    shown = b""
    with contextlib.suppress(OSError):  # raised by reading after the program has ended
        while part := os.read(terminal, 65536):
            shown += part
    assert os.waitpid(pid, 0)[1] == 0, shown
    return shown.decode()
