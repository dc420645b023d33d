"""A worker of a study that reports without a pause, in a module that its process can import."""

from __future__ import annotations

import os

from evoframe.study.pool import _talk


def chatter(number: int) -> None:
    """Report the process id instead of turns until the worker is told to stop."""
    talk = _talk(number)
    while not talk.stop():
        talk.tell(os.getpid(), None)
