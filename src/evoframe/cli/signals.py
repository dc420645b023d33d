"""What Ctrl-C and SIGTERM mean while something long goes on: stop soon; the second time, at once."""

from __future__ import annotations

import contextlib
import signal
from collections.abc import Iterator
from types import FrameType

import click

__all__ = ["Stop", "exit_code", "stop_on_signals"]

_SIGNALS = (signal.SIGINT, signal.SIGTERM)


class Stop:
    """Remembers that somebody asked to stop; a second request stops at once.

    Attributes:
        asked_by: The signal, if somebody did.
    """

    def __init__(self, when: str) -> None:
        self.asked_by: int | None = None
        self._when = when

    def is_asked(self) -> bool:
        """Return whether somebody asked to stop."""
        return self.asked_by is not None

    @property
    def exit_code(self) -> int:
        """What a shell expects of a process that was stopped like this."""
        return exit_code(self.asked_by or signal.SIGINT)

    def handle(self, number: int, frame: FrameType | None) -> None:
        """Note a signal, and say what comes of it.

        Raises:
            KeyboardInterrupt: It is the second.
        """
        if self.asked_by is not None:
            signal.default_int_handler(number, frame)
        self.asked_by = number
        again = "press Ctrl-C again" if number == signal.SIGINT else "send the signal again"
        click.echo(f"\nStopping after {self._when}; {again} to stop at once.", err=True)


def exit_code(number: int) -> int:
    """Return what a shell expects of a process that was ended by a signal."""
    return 128 + number


@contextlib.contextmanager
def stop_on_signals(when: str) -> Iterator[Stop]:
    """Let signals ask to stop after *when*, such as ``this turn``."""
    stop = Stop(when)
    previous = {number: signal.signal(number, stop.handle) for number in _SIGNALS}
    try:
        yield stop
    finally:
        for number, handler in previous.items():
            signal.signal(number, handler)
