"""What a study tells of its progress."""

from __future__ import annotations

from pathlib import Path

import pytest
import toy_box
import toys
from toy_study import STUDY

from evoframe.cli.study_progress import _Work
from evoframe.study.plan import Planned, read_study


@pytest.fixture
def todo(tmp_path: Path) -> list[Planned]:
    """Two runs of as many pairs, in nine turns."""
    (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
    (tmp_path / "study.toml").write_text(STUDY)
    overrides = ["runs=2", "grid.collaboration.n=[1]", "grid.simulator=['toy-product']"]
    study = read_study(tmp_path / "study.toml", overrides, toy_box.installed())
    return list(study.planned(tmp_path))


def test_a_run_is_work_turn_by_turn(todo: list[Planned]) -> None:
    work, pairs = _Work(todo), todo[0].cell.pairs
    assert work.times(1.0) == []
    for turn in (0, 3, 8):
        work.saw(todo[0], turn)
        assert work.done == pytest.approx(pairs * (turn + 1) / 9)
        assert work.left == pytest.approx(2 * pairs - work.done)
    work.ended(todo[0], finished=True)
    assert work.done == pytest.approx(pairs)
    assert work.times(10.0) == [f"{pairs / 10:.0f} pairs/s", "10 s left"]


def test_turns_of_an_earlier_sitting_are_none_of_this_one(todo: list[Planned]) -> None:
    work, pairs = _Work(todo), todo[0].cell.pairs
    work.saw(todo[0], 6)
    assert work.done == pytest.approx(pairs / 9)
    assert work.left == pytest.approx(pairs * (1 + 2 / 9))
    assert work.times(2.0)[1] == "22 s left"
    assert work.bar().completed == pytest.approx(pairs * 7 / 9)


def test_what_is_not_seen_of_the_end_of_a_run_is_work_too(todo: list[Planned]) -> None:
    work, pairs = _Work(todo), todo[0].cell.pairs
    work.saw(todo[0], 0)
    work.ended(todo[0], finished=True)
    assert work.done == pytest.approx(pairs)
    assert work.left == pairs


def test_a_run_that_is_only_verified_is_no_work(todo: list[Planned]) -> None:
    work, pairs = _Work(todo), todo[0].cell.pairs
    work.ended(todo[0], finished=True)
    assert (work.done, work.left) == (0, pairs)


def test_of_a_run_that_failed_or_is_left_to_others_nothing_is_left(todo: list[Planned]) -> None:
    work, pairs = _Work(todo), todo[0].cell.pairs
    work.saw(todo[0], 0)
    work.saw(todo[0], 2)
    work.ended(todo[0], finished=False)
    assert work.done == pytest.approx(pairs / 3)
    assert work.left == pairs


def test_the_meeting_at_the_end_is_no_work(todo: list[Planned]) -> None:
    work = _Work(todo)
    work.saw(todo[0], 9)
    assert (work.done, work.left) == (0, todo[0].cell.pairs)
