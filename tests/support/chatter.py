"""A worker of a study that reports without pause, in a module that its process can import."""

from __future__ import annotations

import os

from evoframe.study.pool import _channel


def chatter(number: int) -> None:
    """Report the process's id in place of a turn, until a stop is requested."""
    channel = _channel(number)
    while not channel.stop():
        channel.report(os.getpid(), None)
