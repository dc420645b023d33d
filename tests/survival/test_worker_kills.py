"""Programs whose workers are killed at any moment give the results of undisturbed ones."""

from __future__ import annotations

import re
from pathlib import Path

from processes import python


def test_sixty_workers_that_are_killed_while_they_start_change_nothing() -> None:
    ran = python(Path(__file__).with_name("worker_kills.py"), "--kills", 60, "--seed", 5)
    assert ran.returncode == 0, ran.stdout + ran.stderr
    counted = re.match(r"(\d+) kills of workers, (\d+) runs:", ran.stdout)
    assert counted, ran.stdout
    assert int(counted[1]) == 60
    assert int(counted[2]) >= 2
