"""A pool of worker processes in which every worker that ends is replaced."""

from __future__ import annotations

import contextlib
import logging
import os
import signal
import threading
from collections import deque
from collections.abc import Callable, Sequence
from concurrent.futures import Future, InvalidStateError
from typing import Any, TypeVar

import attrs

from evoframe.errors import RunError, WorkerError
from evoframe.workers.channel import Channel
from evoframe.workers.child import Begun, Report, Start, is_preparing
from evoframe.workers.process import StartError, Worker, main_program

__all__ = ["WorkerProcesses"]

R = TypeVar("R")

_CRASHES = 5  # of workers in a row, during the same task or during their starts
_KILLS = 20  # during the same task: by others, or by the system for want of memory
_EARLY_KILLS = 1000  # during starts or before the task has begun, which is not its fault
_SUSPICIOUS = 3  # ended workers of one task, to warn of
_PAUSE = 0.1  # s; after a failed start, doubled each time

_log = logging.getLogger(__name__)


def _ignore(_: object) -> None:
    pass


@attrs.define(eq=False)
class _Task:
    """A function call, and its future result.

    Attributes:
        packed: The function and its arguments, and whether the function calls :func:`evoframe.workers.begin`.
        begun: Whether the worker has loaded it.
        crashes: Number of workers that crashed while they executed it, since its last report.
        kills: Number of workers that were killed after it had begun, since its last report.
        early_kills: Number of workers that were killed before.
    """

    packed: tuple[bytes, bool]
    arguments: tuple[Any, ...]
    time_limit: float | None
    on_report: Callable[[Any], object]
    begun: bool = False
    future: Future[Any] = attrs.field(factory=Future)
    crashes: int = 0
    kills: int = 0
    early_kills: int = 0

    def receive(self, message: Begun | Report) -> None:
        """Receive a message; a report proves that the task advances."""
        self.begun = True
        if isinstance(message, Report):
            self.crashes = self.kills = self.early_kills = 0
            self.on_report(message.value)

    def count(self, *, killed: bool) -> int:
        """Count a worker that ended, and return the number of all in a row."""
        if not killed:
            self.crashes += 1
        elif self.begun:
            self.kills += 1
        else:
            self.early_kills += 1
        self.begun = False
        return self.crashes + self.kills + self.early_kills

    def is_hopeless(self) -> bool:
        """Return whether too many workers have ended."""
        return self.crashes >= _CRASHES or self.kills >= _KILLS or self.early_kills >= _EARLY_KILLS

    def settle(self, value: object = None, error: BaseException | None = None) -> None:
        """Set the result, unless there is one already."""
        with contextlib.suppress(InvalidStateError):
            if error is None:
                self.future.set_result(value)
            else:
                self.future.set_exception(error)


class WorkerProcesses:
    """A pool of worker processes, which start with the first task and ignore Ctrl-C.

    A worker that ends is replaced, also if it ended during its start, and its task is repeated. A task
    without a result raises :class:`TimeoutError` if it exceeded its time limit and its worker was killed;
    :class:`WorkerError` if five workers crashed while they executed it, or 20 were killed (each report of the
    task starts a new count); and :class:`RunError` if the pool was closed or cannot start
    workers.

    Each worker has a connection and a thread of its own in this process. Text that workers print goes to
    standard error.

    Args:
        workers: Number of processes.
        initializer: Function that each process calls before its first task.
        initargs: Arguments of *initializer*, which can be pickled.
    """

    def __init__(
        self, workers: int, initializer: Callable[..., object] | None = None, initargs: Sequence[Any] = ()
    ) -> None:
        self._workers = workers
        self._initializer, self._initargs = initializer, tuple(initargs)
        self._threads: list[threading.Thread] = []
        self._changed = threading.Condition()  # guards all of the following
        self._tasks: deque[_Task] = deque()
        self._outstanding: set[_Task] = set()
        self._busy: set[Worker] = set()  # workers that start or execute a task
        self._closed = False
        self._stop_requested = False
        self._stop: list[int] = []  # reading and writing end of a pipe; closing the latter requests a stop

    @property
    def active(self) -> bool:
        """True if the pool accepts tasks."""
        return not self._closed

    def schedule(
        self,
        function: Callable[..., R],
        arguments: Sequence[Any],
        time_limit: float | None = None,
        on_report: Callable[[Any], object] = _ignore,
        *,
        begins_itself: bool = False,
    ) -> Future[R]:
        """Schedule the call of a function in a worker.

        Args:
            function: A function that can be imported by name.
            arguments: Arguments of the function.
            time_limit: Time after which the worker is killed, s.
            on_report: Called, in a thread, with each value that the function passes to
                :func:`evoframe.workers.report`.
            begins_itself: Whether the function calls :func:`evoframe.workers.begin`. Workers that are killed
                before do not count against the task; by default it begins when its modules are imported.

        Raises:
            RunError: The pool is closed, or cannot start workers.
        """
        packed = Channel.pack((function, tuple(arguments))), begins_itself
        task = _Task(packed, tuple(arguments), time_limit, on_report)
        with self._changed:
            if self._closed:
                raise RunError("the worker processes were shut down")
            self._tasks.append(task)
            self._outstanding.add(task)
            self._changed.notify_all()
        if not self._threads:
            self._start_threads()
        return task.future

    def request_stop(self) -> None:
        """Request all tasks to stop: :func:`evoframe.workers.stop_requested` is true in all workers."""
        with self._changed:
            self._stop_requested = True
            for end in self._stop[1:]:
                os.close(end)
            del self._stop[1:]

    def close(self) -> None:
        """Stop the workers immediately; tasks without a result raise RunError."""
        self._shut_down(RunError("the worker processes were shut down"))
        for thread in self._threads:
            thread.join()
        with self._changed:
            for end in self._stop:
                os.close(end)
            self._stop.clear()

    def _start_threads(self) -> None:
        try:
            if is_preparing():
                raise RunError(
                    "the main program starts worker processes when they import it; move its code below "
                    "\"if __name__ == '__main__':\""
                )
            self._stop = [*os.pipe()]
            if self._stop_requested:
                self.request_stop()
            start = Start(main_program(), self._initializer, self._initargs)
            for _ in range(self._workers):
                thread = threading.Thread(target=self._serve, args=[start], daemon=True)
                thread.start()
                self._threads.append(thread)
        except (OSError, RuntimeError) as error:  # no files, threads or working directory
            self.close()
            raise RunError(f"worker processes cannot be started: {error}") from error

    def _serve(self, start: Start) -> None:
        """Start a worker, pass tasks to it, and replace it whenever it ends."""
        try:
            # Inherited by the processes: only this one handles Ctrl-C.
            signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
            while (worker := self._next_worker(start)) is not None:
                self._use(worker)
        except BaseException as error:  # noqa: BLE001 - its tasks must not wait for ever
            self._shut_down(error)

    def _next_worker(self, start: Start) -> Worker | None:
        """Return a worker that is ready; ``None`` if the pool was closed.

        Raises:
            RunError: Workers cannot be started.
        """
        failed = 0
        for ended in range(1, _EARLY_KILLS + 1):
            try:
                return self._started(start)
            except StartError as error:
                _log.info("a worker process ended while it started: %s", error)
                failed += not error.killed
                if failed == _CRASHES or ended == _EARLY_KILLS:
                    raise RunError(
                        f"worker processes cannot be started: {ended} in a row ended, the last one with "
                        f"{error}"
                    ) from error
                with self._changed:
                    pause = 0.0 if error.killed else _PAUSE * 2 ** (failed - 1)
                    self._changed.wait_for(lambda: self._closed, pause)
        raise AssertionError  # the last attempt returns or raises

    def _started(self, start: Start) -> Worker | None:
        if self._closed:
            return None
        try:
            worker = Worker(self._stop[0], start.program["sys_path"], self._notify)
        except (OSError, RuntimeError, MemoryError) as error:  # no processes, files, threads or memory
            raise StartError(f"{type(error).__name__}: {error}") from error
        with self._changed:
            self._busy.add(worker)
            if self._closed:
                worker.kill()
        try:
            worker.prepare(start)
        except BaseException:
            self._dismiss(worker)
            raise
        return worker

    def _use(self, worker: Worker) -> None:
        """Pass tasks to a worker until it ends or the pool is closed."""
        try:
            while (task := self._take(worker)) is not None and self._executes(worker, task):
                pass
        finally:
            self._dismiss(worker)

    def _take(self, worker: Worker) -> _Task | None:
        """Return the next task; ``None`` if the worker has ended or the pool is closed."""
        with self._changed:
            self._busy.discard(worker)
            while True:
                self._changed.wait_for(lambda: self._closed or worker.ended or self._tasks)
                if self._closed or worker.ended:
                    return None
                task = self._tasks.popleft()
                if task.future.running() or task.future.set_running_or_notify_cancel():
                    self._busy.add(worker)
                    return task
                self._outstanding.discard(task)

    def _executes(self, worker: Worker, task: _Task) -> bool:
        """Execute a task, and return whether its worker can execute another one."""
        try:
            result = worker.execute(task.packed, task.time_limit, task.receive)
        except EOFError:
            self._repeat(task, worker)
            return False
        except Exception as error:  # noqa: BLE001 - beyond the time limit; failure of a callback
            worker.kill()
            self._settle(task, error=error)
            return False
        self._settle(task, result.value, result.error)
        return True

    def _repeat(self, task: _Task, worker: Worker) -> None:
        """Schedule a task whose worker has ended again, before all others, unless too many have ended."""
        ending = worker.ending()
        ended = task.count(killed=worker.killed)
        if task.is_hopeless():
            problem = f"its worker process ended with {ending}; {ended} of them ended in a row"
            self._settle(task, error=WorkerError(problem, task.arguments))
            return
        level = logging.WARNING if ended == _SUSPICIOUS and not self._closed else logging.INFO
        _log.log(level, "a worker process ended with %s; its work is repeated, attempt %d", ending, ended + 1)
        with self._changed:
            self._tasks.appendleft(task)
            self._changed.notify_all()

    def _settle(self, task: _Task, value: object = None, error: BaseException | None = None) -> None:
        with self._changed:
            self._outstanding.discard(task)
        task.settle(value, error)

    def _dismiss(self, worker: Worker) -> None:
        with self._changed:
            self._busy.discard(worker)
        worker.finish()

    def _shut_down(self, error: BaseException) -> None:
        """Kill all busy workers, and fail all tasks without a result; idle workers exit."""
        with self._changed:
            self._closed = True
            busy, tasks = set(self._busy), set(self._outstanding)
            self._outstanding.clear()
            self._changed.notify_all()
        for worker in busy:
            worker.kill()
        for task in tasks:
            task.settle(error=error)

    def _notify(self) -> None:
        with self._changed:
            self._changed.notify_all()
