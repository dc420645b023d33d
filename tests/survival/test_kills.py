"""Runs that are killed repeatedly give the results of uninterrupted runs."""

from __future__ import annotations

import re
from pathlib import Path

from processes import python


def test_runs_that_are_killed_fifty_times_equal_uninterrupted_runs() -> None:
    ran = python(Path(__file__).with_name("kills.py"), "--kills", 50, "--seed", 11)
    assert ran.returncode == 0, ran.stderr
    counted = re.match(r"(\d+) kills \D*\((\d+) ", ran.stdout)
    assert counted, ran.stdout
    kills, inside = map(int, counted.groups())
    assert kills >= 50
    assert 10 <= inside <= kills - 10
    by_kind = [int(count) for count in re.findall(r"[a-z] (\d+)[,)]", ran.stdout)]
    assert sum(by_kind) == kills
    assert len(by_kind) == 6
    assert min(by_kind) > 0
    assert ran.stdout.count("\n") == 1  # printed only if all results are equal
