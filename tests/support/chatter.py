"""A task of a worker that reports without pause, in a module that its process can import."""

from __future__ import annotations

import os

from evoframe.workers import report, stop_requested


def chatter(number: int) -> int:
    """Report a number and the process's id, until a stop is requested; return the number."""
    while not stop_requested():
        report((number, os.getpid()))
    return number
