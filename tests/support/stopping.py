"""A plugin that interrupts a run from within, as Ctrl-C does: after the turn in ``STOPPING_AFTER_TURN``.

A test that interrupts a run with it does not depend on how fast the run and the test are.
"""

from __future__ import annotations

import os
import signal

from evoframe import Turn, hookimpl


@hookimpl
def evoframe_turn_finished(turn: Turn) -> None:
    if turn.index == int(os.environ["STOPPING_AFTER_TURN"]):
        os.kill(os.getpid(), signal.SIGINT)
