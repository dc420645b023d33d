"""A worker of a study that tells without a pause, in a module that its process can import."""

from __future__ import annotations

import os

from evoframe.study.pool import _talk


def chatter(number: int) -> None:
    """Tell in place of a turn which process this is, until it is asked to stop."""
    talk = _talk(number)
    while not talk.stop():
        talk.tell(os.getpid(), None)
