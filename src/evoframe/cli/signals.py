"""Stop on Ctrl-C or SIGTERM: the first signal requests a stop, a second one stops at once."""

from __future__ import annotations

import contextlib
import signal
from collections.abc import Iterator
from types import FrameType

import click

__all__ = ["Stop", "exit_code", "stop_on_signals"]

_SIGNALS = (signal.SIGINT, signal.SIGTERM)


class Stop:
    """A request to stop; a second request stops at once.

    Attributes:
        asked_by: The signal that requested it, if any.
    """

    def __init__(self, when: str) -> None:
        self.asked_by: int | None = None
        self._when = when

    def is_asked(self) -> bool:
        """Return whether a stop was requested."""
        return self.asked_by is not None

    @property
    def exit_code(self) -> int:
        """Exit code that a shell expects after this stop."""
        return exit_code(self.asked_by or signal.SIGINT)

    def handle(self, number: int, frame: FrameType | None) -> None:
        """Record a signal and report its effect.

        Raises:
            KeyboardInterrupt: This is the second signal.
        """
        if self.asked_by is not None:
            signal.default_int_handler(number, frame)
        self.asked_by = number
        again = "press Ctrl-C again" if number == signal.SIGINT else "send the signal again"
        click.echo(f"\nStopping after {self._when}; {again} to stop at once.", err=True)


def exit_code(number: int) -> int:
    """Return the exit code that a shell expects of a process ended by a signal."""
    return 128 + number


@contextlib.contextmanager
def stop_on_signals(when: str) -> Iterator[Stop]:
    """Handle signals as requests to stop after *when*, such as ``this turn``."""
    stop = Stop(when)
    previous = {number: signal.signal(number, stop.handle) for number in _SIGNALS}
    try:
        yield stop
    finally:
        for number, handler in previous.items():
            signal.signal(number, handler)
