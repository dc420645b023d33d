"""One worker process: its start, the tasks it executes, and its end."""

from __future__ import annotations

import contextlib
import multiprocessing.spawn
import os
import signal
import socket
import subprocess
import threading
import time
from collections.abc import Callable, Sequence
from typing import Any

from evoframe.workers.channel import Channel
from evoframe.workers.child import Begun, Failed, Ready, Report, Result, Start

__all__ = ["StartError", "Worker", "main_program"]

_START_LIMIT = 120.0  # s; far more than a start takes on a busy computer
_GRACE = 5.0  # s; time to end after the connection is closed, before the process is killed
_COLLECTED = 16384  # latest bytes of the output during a start
_SHOWN = 2000  # latest characters of a failed start's output, in its error

# Unlike sys.path of the option -c, that of the parent does not begin with the working directory.
_PROGRAM = "import sys; sys.path[:] = {path!r}; from evoframe.workers.child import main; main({ours}, {stop})"

_SIGNALS = {each.value: each.name for each in signal.Signals}
_FROM_OTHERS = frozenset({signal.SIGHUP, signal.SIGINT, signal.SIGKILL, signal.SIGTERM})


class StartError(Exception):
    """A worker process that ended before it was ready.

    Attributes:
        killed: Whether another process, or the system, ended it.
    """

    def __init__(self, problem: str, *, killed: bool = False) -> None:
        super().__init__(problem)
        self.killed = killed


def main_program() -> dict[str, Any]:
    """Return the description of this program that a worker needs to find its objects by name."""
    program = dict(multiprocessing.spawn.get_preparation_data("worker"))
    program.pop("authkey")  # a secret that no worker needs
    return program


class Worker:
    """A worker process, which ends with this process.

    One process has one connection, and shares no lock and no semaphore with others: wherever it is killed,
    only its connection ends. multiprocessing.Process is not used, since it starts a further process that
    tracks resources, and prints on the terminal if that is killed.

    Args:
        stop: File descriptor that becomes readable when a stop is requested.
        path: Paths to search for modules.
        on_end: Called, in a thread, when the process has ended.
    """

    def __init__(self, stop: int, path: Sequence[str], on_end: Callable[[], object]) -> None:
        self._on_end = on_end
        self._collected, self._ended = threading.Event(), threading.Event()
        self._output = b""
        _occupy_standard_streams()
        here, there = socket.socketpair()
        self._channel = Channel(here)
        try:
            with there:
                self._process = _spawn(there.fileno(), stop, path)
        except BaseException:
            self._channel.close()
            raise
        try:
            threading.Thread(target=self._await_end, daemon=True).start()
        except RuntimeError:  # no more threads
            self._process.kill()
            self._await_end()
            self._channel.close()
            raise

    @property
    def ended(self) -> bool:
        """True if the process has ended."""
        return self._ended.is_set()

    @property
    def killed(self) -> bool:
        """True if a signal ended the process that others send, not one of a crash."""
        return -(self._process.returncode or 0) in _FROM_OTHERS

    def prepare(self, start: Start) -> None:
        """Wait until the process is ready.

        Raises:
            StartError: It has ended, or is not ready in time.
        """
        deadline = time.monotonic() + _START_LIMIT
        try:
            self._channel.send(start, deadline)
            answer: Ready | Failed = self._channel.receive(deadline)
        except TimeoutError as error:
            self.kill()
            raise StartError(f"not ready after {_START_LIMIT:g} s") from error
        except EOFError as error:
            ending = self.ending()
            problem = ": ".join(filter(None, [ending, self._last_output()]))
            raise StartError(problem, killed=self.killed) from error
        if isinstance(answer, Failed):
            self.kill()
            raise StartError(answer.cause)
        self._collected.wait()  # the process has stopped writing to it
        if self._output:  # such as times of imports, with -X importtime
            with contextlib.suppress(OSError):  # a broken log does not end a run
                os.write(2, self._output)

    def execute(
        self,
        task: tuple[bytes, bool],
        time_limit: float | None,
        on_message: Callable[[Begun | Report], object],
    ) -> Result:
        """Execute a task.

        Args:
            task: The function and its arguments, packed by :meth:`Channel.pack`, and whether the function
                calls :func:`evoframe.workers.begin`.
            time_limit: Time after which the process is killed, s.
            on_message: Called with each message of the task.

        Raises:
            EOFError: The process has ended.
            TimeoutError: The task exceeded its time limit; the process is killed.
        """
        deadline = None if time_limit is None else time.monotonic() + time_limit
        try:
            self._channel.send(task, deadline)
            while not isinstance(answer := self._channel.receive(deadline), Result):
                on_message(answer)
        except TimeoutError:
            self.kill()
            raise
        return answer

    def ending(self) -> str:
        """Wait until the process has ended, and return its exit code or signal as text."""
        if not self._ended.wait(_GRACE):
            self.kill()
            self._ended.wait(_GRACE)
        code = self._process.returncode
        if code is None:  # the system has not ended it yet
            return "an unknown exit code"
        return f"exit code {code}" if code >= 0 else f"the signal {_SIGNALS.get(-code, -code)}"

    def kill(self) -> None:
        """Kill the process, also if it is stopped."""
        self._process.kill()

    def finish(self) -> None:
        """End the connection, so that an idle process exits, and wait for its end."""
        self._channel.shutdown()
        self.ending()
        self._channel.close()

    def _await_end(self) -> None:
        assert self._process.stdin is not None  # noqa: S101 - a pipe
        assert self._process.stderr is not None  # noqa: S101 - a pipe
        with contextlib.suppress(MemoryError), self._process.stderr as output:  # the end matters more
            while piece := os.read(output.fileno(), 4096):
                self._output = (self._output + piece)[-_COLLECTED:]
        self._collected.set()
        self._process.wait()
        self._process.stdin.close()
        self._ended.set()
        self._channel.shutdown()  # a process that the worker has forked can hold the other end open
        self._on_end()

    def _last_output(self) -> str:
        return self._output.decode(errors="backslashreplace").strip()[-_SHOWN:]


def _spawn(connection: int, stop: int, path: Sequence[str]) -> subprocess.Popen[bytes]:
    """Start a process of :func:`evoframe.workers.child.main`."""
    code = _PROGRAM.format(path=list(path), ours=connection, stop=stop)
    executable, *options = multiprocessing.spawn.get_command_line()[:-3]  # without the program of its own
    return subprocess.Popen(  # noqa: S603 - this interpreter
        [executable, *options, "-P", "-c", code],
        stdin=subprocess.PIPE,  # never written to: it closes when this process ends
        stdout=2,  # what simulators print never mixes with the output of a command
        stderr=subprocess.PIPE,
        pass_fds=[connection, stop],
        bufsize=0,
    )


def _occupy_standard_streams() -> None:
    """Open closed standard streams on the null device, so that no connection gets their numbers."""
    while (number := os.open(os.devnull, os.O_RDWR)) <= 2:
        os.set_inheritable(number, True)  # noqa: FBT003 - of the standard library
    os.close(number)
