"""Stop on Ctrl-C or SIGTERM: the first signal requests a stop, a second one stops at once.

Python handles a signal only between two of its instructions, and a simulation in C can be long. Therefore a
thread watches the signals, too. It ends the process if Python does not do so soon.
"""

from __future__ import annotations

import contextlib
import os
import signal
import threading
from collections.abc import Callable, Iterator
from types import FrameType

import click

__all__ = ["Stop", "ended_by_signal", "exit_code", "stop_on_signals"]

_SIGNALS = (signal.SIGINT, signal.SIGTERM)
_GRACE = 2.0  # s, for Python to end the program by itself


class Stop:
    """A request to stop; a second request stops at once.

    Attributes:
        asked_by: The signal that requested it, if any.
    """

    def __init__(self, when: str) -> None:
        self.asked_by: int | None = None
        self._when = when
        self._handled = 0
        self._lock = threading.Lock()

    def is_asked(self) -> bool:
        """Return whether a stop was requested."""
        return self.asked_by is not None

    @property
    def exit_code(self) -> int:
        """Exit code that a shell expects after this stop."""
        return exit_code(self.asked_by or signal.SIGINT)

    def ask(self, number: int) -> None:
        """Record the first signal and report its effect; later calls do nothing."""
        with self._lock:
            if self.asked_by is not None:
                return
            self.asked_by = number
        again = "press Ctrl-C again" if number == signal.SIGINT else "send the signal again"
        click.echo(f"\nStopping after {self._when}; {again} to stop at once.", err=True)

    def handle(self, number: int, frame: FrameType | None) -> None:
        """Handle a signal in the main thread.

        Raises:
            KeyboardInterrupt: This is the second signal.
        """
        self._handled += 1
        if self._handled > 1:
            signal.default_int_handler(number, frame)
        self.ask(number)


def exit_code(number: int) -> int:
    """Return the exit code that a shell expects of a process ended by a signal."""
    return 128 + number


@contextlib.contextmanager
def stop_on_signals(when: str, last_words: Callable[[], str] = lambda: "Interrupted") -> Iterator[Stop]:
    """Handle signals as requests to stop.

    Args:
        when: After what it stops, such as ``this turn``.
        last_words: Returns the message if the process is ended from outside of the main thread.
    """
    stop = Stop(when)
    previous = {number: signal.signal(number, stop.handle) for number in _SIGNALS}
    try:
        with _watched(2, stop.ask, last_words):
            yield stop
    finally:
        for number, handler in previous.items():
            signal.signal(number, handler)


def ended_by_signal(last_words: str = "Interrupted") -> contextlib.AbstractContextManager[None]:
    """Return a context in which Ctrl-C ends the process soon, also during a long simulation in C."""
    return _watched(1, lambda _: None, lambda: last_words)


@contextlib.contextmanager
def _watched(last: int, on_first: Callable[[int], None], last_words: Callable[[], str]) -> Iterator[None]:
    """Watch signals that Python handles, and end the process soon after the one with the number *last*."""
    receiver, sender = os.pipe()
    os.set_blocking(sender, False)
    previous = signal.set_wakeup_fd(sender, warn_on_full_buffer=False)
    left = threading.Event()
    watch = threading.Thread(target=_watch, args=(receiver, left, last, on_first, last_words), daemon=True)
    watch.start()
    try:
        yield
    finally:
        left.set()
        signal.set_wakeup_fd(previous)
        os.close(sender)  # ends the thread
        watch.join()
        os.close(receiver)


def _watch(
    receiver: int,
    left: threading.Event,
    last: int,
    on_first: Callable[[int], None],
    last_words: Callable[[], str],
) -> None:
    seen = 0
    while data := os.read(receiver, 1):
        number = data[0]
        if number not in _SIGNALS:
            continue
        seen += 1
        if seen == 1:
            on_first(number)
        if seen == last:
            if not left.wait(_GRACE):
                _end(number, last_words())
            return


def _end(number: int, words: str) -> None:
    """End this process, and thereby its workers; everything that was saved stays saved."""
    try:
        click.echo(words, err=True)
    finally:
        os._exit(exit_code(number))
