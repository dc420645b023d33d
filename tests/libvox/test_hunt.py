"""A hunt of 200 bodies finds no difference between what is computed and the whole body."""

from __future__ import annotations

import re
from pathlib import Path

from processes import python


def test_a_short_hunt_finds_no_difference() -> None:
    ran = python(Path(__file__).with_name("hunt.py"), 600, "--seed", 1, "--cases", 200)
    assert ran.returncode == 0, ran.stdout + ran.stderr
    counted = re.search(r"200 bodies, (\d+) simulations, (\d+) repeated", ran.stdout)
    assert counted, ran.stdout
    assert 0 < int(counted[2]) < int(counted[1])
