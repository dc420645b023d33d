"""Child processes that measure on request, in other environments than this one."""

from __future__ import annotations

import contextlib
import json
import os
import subprocess
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import IO, Any

import attrs

from benchmarks.report import SectionError

__all__ = ["CHILDREN", "Child", "started"]

CHILDREN = Path(__file__).parent / "children"
"""The folder of the programs that child processes run."""


@attrs.frozen
class Child:
    """A process that replies to requests until its input is closed.

    Attributes:
        name: Its name in errors.
    """

    name: str
    _process: subprocess.Popen[str]
    _log: IO[str]

    def ask(self, do: str, **arguments: Any) -> Any:
        """Return the result of a request.

        Raises:
            SectionError: The request failed, or the process has ended.
        """
        requests, replies = self._process.stdin, self._process.stdout
        if requests is None or replies is None:
            raise AssertionError("the process was started with pipes")
        with contextlib.suppress(BrokenPipeError):  # then there is no reply
            requests.write(json.dumps({"do": do, **arguments}) + "\n")
            requests.flush()
        line = replies.readline()
        if not line:
            raise SectionError(
                f"{self.name} ended with exit code {self._process.wait()}: {self._last_line()}"
            )
        reply = json.loads(line)
        if "error" in reply:
            raise SectionError(f"{self.name} cannot {do}: {reply['error']}")
        return reply["result"]

    def _last_line(self) -> str:
        self._log.seek(0)
        lines = self._log.read().strip().splitlines()
        return lines[-1] if lines else "it printed nothing"


@contextlib.contextmanager
def started(name: str, command: Sequence[str], environment: Mapping[str, str]) -> Iterator[Child]:
    """Start a child process, and end it with the ``with`` block.

    Args:
        name: Its name in errors.
        command: Its command line.
        environment: Variables that differ from those of this process.

    Raises:
        SectionError: The command cannot be executed.
    """
    with tempfile.TemporaryDirectory() as directory, tempfile.TemporaryFile("w+", encoding="utf-8") as log:
        try:
            process = subprocess.Popen(
                command,
                cwd=directory,
                env={**os.environ, **environment},
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=log,
                encoding="utf-8",
            )
        except OSError as error:
            raise SectionError(f"{name} cannot be started: {command[0]}: {error.strerror}") from error
        with process:
            try:
                yield Child(name, process, log)
            except BaseException:
                process.kill()
                raise
            finally:
                _close_input(process)


def _close_input(process: subprocess.Popen[str]) -> None:
    """End a process that waits for requests; one that has ended may leave an unread request."""
    with contextlib.suppress(BrokenPipeError):
        if process.stdin is not None:
            process.stdin.close()
