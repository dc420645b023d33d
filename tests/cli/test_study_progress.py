"""What a study tells of its progress."""

from __future__ import annotations

from pathlib import Path

import pytest
import toy_box
import toys
from toy_study import STUDY

from evoframe.cli.study_progress import StudyProgress, _Work, duration
from evoframe.study import End, Planned, Row, Study, read_study


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


class TestProgress:
    @pytest.fixture
    def study(self, todo: list[Planned], tmp_path: Path) -> Study:
        overrides = ["runs=2", "grid.collaboration.n=[1]", "grid.simulator=['toy-product']"]
        return read_study(tmp_path / "study.toml", overrides, toy_box.installed())

    def test_without_a_terminal_each_run_has_a_line(
        self, study: Study, capsys: pytest.CaptureFixture[str]
    ) -> None:
        first, second = study.planned(Path("there"))
        with StudyProgress(quiet=False) as progress:
            progress.on_begin(study, [first, second], {})
            for planned in (first, second):
                progress.on_run_started(planned)
            progress.on_turn_finished(first, 0, 2.0)
            progress.on_run_ended(first, End("finished", score=2.5))
            progress.on_tick()
            progress.on_run_ended(second, End("failed", "a fault"))
        one, other = capsys.readouterr().err.splitlines()
        assert one.startswith(f"{first.label}: finished, best pair 2.5  1/2 runs done, 1 running, 0 left, ")
        assert other.startswith(
            f"{second.label}: failed: a fault  1/2 runs done, 0 running, 0 left, 1 failed"
        )

    def test_what_is_done_already_counts(self, study: Study, capsys: pytest.CaptureFixture[str]) -> None:
        first, second = study.planned(Path("there"))
        row = Row({}, 0, 0, "", "", 1.0, 2.0, 1.5, 8, 8, 0.1, "")
        progress = StudyProgress(quiet=False)
        progress.on_begin(study, [second], {first: row})
        progress.on_run_started(second)
        progress.on_run_ended(second, End("elsewhere"))
        line = f"{second.label}: elsewhere  1/2 runs done, 0 running, 0 left, 1 running in other processes"
        assert capsys.readouterr().err == f"{line}\n"

    def test_quiet_shows_only_what_failed(self, study: Study, capsys: pytest.CaptureFixture[str]) -> None:
        first, second = study.planned(Path("there"))
        progress = StudyProgress(quiet=True)
        progress.on_begin(study, [first, second], {})
        for planned, end in ((first, End("finished", score=1.0)), (second, End("failed", "a fault"))):
            progress.on_run_started(planned)
            progress.on_run_ended(planned, end)
        assert capsys.readouterr().err.startswith(f"{second.label}: failed: a fault  ")


@pytest.mark.parametrize(
    ("seconds", "shown"),
    [(0.4, "0 s"), (89.0, "89 s"), (90.0, "2 min"), (5340.0, "89 min"), (12000.0, "3 h 20 min")],
)
def test_durations_are_rounded_for_a_person(seconds: float, shown: str) -> None:
    assert duration(seconds) == shown
