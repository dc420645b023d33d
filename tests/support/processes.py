"""Programs in separate processes, as users start them."""

from __future__ import annotations

import contextlib
import os
import pty
import select
import shlex
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from queue import Empty, SimpleQueue
from types import TracebackType
from typing import Any

LIMIT = 300.0
"""Longest time to wait for a program, s; it only ends tests that have failed, so no computer is too busy."""

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
    try:
        return subprocess.run(
            [sys.executable, *map(str, arguments)],
            cwd=directory,
            env={**surroundings(), **environment},
            capture_output=True,
            text=True,
            check=False,
            timeout=LIMIT,
        )
    except subprocess.TimeoutExpired as error:
        said = [text for text in (error.stdout, error.stderr) if text]
        raise AssertionError(f"the program still runs after {LIMIT:g} s: {said}") from error


def with_pipe(text: str, *arguments: object, directory: Path) -> subprocess.CompletedProcess[str]:
    """Run the program in a shell, with a process substitution that prints *text* as its last argument."""
    words = shlex.join([sys.executable, "-m", "evoframe", *map(str, arguments)])
    return subprocess.run(
        ["bash", "-c", f"{words} <(printf %s {shlex.quote(text)})"],  # noqa: S607 - the user's shell
        cwd=directory,
        env={**surroundings(), "COLUMNS": "100"},
        capture_output=True,
        text=True,
        check=False,
        timeout=LIMIT,
    )


def eventually(condition: Callable[[], object], failure: str) -> None:
    """Wait until a condition holds."""
    until = time.monotonic() + LIMIT
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


class Program(subprocess.Popen[str]):
    """A program in the background.

    Attributes:
        log: Lines of its standard error so far.
    """

    def __init__(self, command: list[str], **options: Any) -> None:
        super().__init__(command, stderr=subprocess.PIPE, text=True, **options)
        self.log: list[str] = []
        self._lines: SimpleQueue[str | None] = SimpleQueue()
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self._reader.join(LIMIT)
        super().__exit__(kind, error, traceback)

    def _read(self) -> None:
        assert self.stderr is not None
        for line in self.stderr:
            self.log.append(line)
            self._lines.put(line)
        self._lines.put(None)

    def next_line(self, until: float) -> str | None:
        """Return the next line of its log, when it comes; ``None`` at the end."""
        try:
            return self._lines.get(timeout=max(0.0, until - time.monotonic()))
        except Empty:
            raise AssertionError(f"the program wrote nothing more for {LIMIT:g} s: {self.log}") from None


@contextlib.contextmanager
def started(directory: Path, *arguments: object) -> Iterator[Program]:
    """Start the program in the background; kill it at the end of the block."""
    command = [sys.executable, "-m", "evoframe", *map(str, arguments)]
    with Program(command, cwd=directory, env=surroundings()) as program:
        try:
            yield program
        finally:
            program.kill()


def told(program: Program, words: str) -> str:
    """Read the log of a program up to a line that contains *words*; return that line."""
    until = time.monotonic() + LIMIT
    while (line := program.next_line(until)) is not None:
        if words in line:
            return line
    raise AssertionError(f"the program ended without {words!r}: {program.log}")


def ended(program: Program) -> int:
    """Wait for the end of a program; return its exit code."""
    until = time.monotonic() + LIMIT
    while program.next_line(until) is not None:
        pass
    return program.wait(LIMIT)


def children(process: int) -> list[int]:
    """Return the ids of the children of a process that have not ended."""
    found = []
    for path in Path(f"/proc/{process}/task").glob("*/children"):  # each thread has its own
        with contextlib.suppress(OSError):  # the thread has ended
            found += [child for child in map(int, path.read_text().split()) if not is_ended(child)]
    return found


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
        while select.select([terminal], [], [], LIMIT)[0] and (part := os.read(terminal, 65536)):
            shown += part
    assert os.waitpid(pid, 0)[1] == 0, shown
    return shown.decode()
