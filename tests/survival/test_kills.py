"""Runs that are killed again and again end as if nothing had happened."""

from __future__ import annotations

import re
from pathlib import Path

from processes import python


def test_a_run_that_is_killed_fifty_times_equals_one_that_is_not() -> None:
    ran = python(Path(__file__).with_name("kills.py"), "--kills", 50, "--seed", 11)
    assert ran.returncode == 0, ran.stderr
    counted = re.match(r"(\d+) kills after a saved turn \((\d+) of them while something was", ran.stdout)
    assert counted, ran.stdout
    kills, inside = map(int, counted.groups())
    assert kills >= 50
    assert 10 <= inside <= kills - 10
    assert ran.stdout.endswith("all equal to undisturbed runs\n")
