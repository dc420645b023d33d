"""A plugin that holds a run after each of its turns while a file named ``pause`` exists.

A test that acts during a run creates the file before, acts after the first turn, and removes it: it does not
depend on how fast the run and the test are.
"""

from __future__ import annotations

import time
from pathlib import Path

from evoframe import Turn, hookimpl


@hookimpl
def evoframe_turn_finished(turn: Turn) -> None:
    del turn
    while Path("pause").exists():
        time.sleep(0.01)
