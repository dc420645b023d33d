"""What a run shows while it goes on."""

from __future__ import annotations

import itertools
import re
from collections.abc import Callable
from pathlib import Path

import pytest
import toys
from processes import on_a_terminal

from evoframe import RunConfig, assemble
from evoframe.cli.progress import Progress


def test_on_a_terminal_there_is_a_bar_that_is_taken_away_at_the_end(tmp_path: Path) -> None:
    (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
    slow = ["--set", "simulator={name='toy-slow', delay=0.15}"]
    shown = on_a_terminal(["run", "-p", toys.__file__, "toy.toml", *slow], tmp_path)
    assert re.search(r"turn \d+/8 .*\d:\d\d:\d\d\S* left", shown)
    assert re.search(r"a \S+  b \S+  \d+ simulations/s  \d+%", shown)
    hidden, back = shown.count("\x1b[?25l"), shown.count("\x1b[?25h")
    assert hidden == back > 0  # the cursor


def test_without_a_terminal_a_line_is_printed_now_and_then(
    toy_config: Callable[..., RunConfig], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    clock = itertools.count()
    monkeypatch.setattr("time.monotonic", lambda: float(next(clock)))  # a turn takes a second
    config, progress = toy_config(), Progress()
    progress.evoframe_run_started(config, Path("here"))
    for turn in assemble(config):
        progress.evoframe_turn_finished(turn)
    progress.evoframe_run_finished()
    first, *lines = capsys.readouterr().err.splitlines()
    assert first.startswith("toy, seed 3: 8 turns")
    assert first.endswith(" here")
    assert [line.split()[1] for line in lines] == ["4/8", "8/8"]
    assert lines[0].endswith("  4 s left")
    assert lines[1].endswith("  0 s left")
