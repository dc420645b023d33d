"""Studies from Python."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import attrs
import pytest
import toys
from processes import python

from evoframe import InputError, plan_study, run_study
from evoframe.study.api import StudyResult
from evoframe.study.conduct import STUDY_FILE, Watcher
from evoframe.study.plan import Planned, Study
from evoframe.study.pool import End
from evoframe.study.progress import FAILURE_FILE, REMEDY
from evoframe.study.rows import Row, read_rows

Read = Callable[..., Study]

PAGE = Path(__file__).parents[2] / "docs" / "studies.md"


@attrs.define
class Notes(Watcher):
    """A watcher that records what it receives."""

    done: int = 0
    ends: list[End] = attrs.field(factory=list)
    started: list[Planned] = attrs.field(factory=list)

    def on_begin(self, study: Study, todo: Sequence[Planned], done: Mapping[Planned, Row]) -> None:
        self.done = len(done)

    def on_run_started(self, planned: Planned) -> None:
        self.started.append(planned)

    def on_run_ended(self, planned: Planned, end: End) -> None:
        self.ends.append(end)


@pytest.fixture
def few(toy_study: Read) -> Study:
    """A study of two runs."""
    return toy_study("runs=1", "grid.collaboration.n=[1]")


@pytest.fixture
def run(few: Study, tmp_path: Path) -> Callable[..., StudyResult]:
    def run_it(study: Study = few, **given: Any) -> StudyResult:
        return run_study(
            study, **{"out": tmp_path / "there", "modules": [toys.__file__], "workers": 1, **given}
        )

    return run_it


def test_missing_runs_are_executed_and_finished_runs_are_returned(
    run: Callable[..., StudyResult], few: Study, tmp_path: Path
) -> None:
    notes = Notes()
    made = run(watcher=notes)
    assert made.directory == tmp_path / "there"
    assert [run.cell for run in made.rows] == list(few.cells)
    assert (made.failed, made.left) == ({}, [])
    assert [end.score for end in notes.ends] == [row.score for row in made.rows.values()]
    written = [attrs.evolve(row, score_curve=(), fitness_curve=()) for row in made.rows.values()]
    (made.directory / "curves.csv").unlink()
    assert read_rows(made.directory / "rows.csv") == written
    again = Notes()
    assert run(watcher=again) == made
    assert (again.done, again.started) == (2, [])


def test_a_run_that_fails_is_reported_and_stops_no_other(
    run: Callable[..., StudyResult], toy_study: Read, tmp_path: Path
) -> None:
    sound = tmp_path / "sound"
    grid = f'grid.simulator=["toy-product", {{name="toy-unsound", sound="{sound}"}}]'
    study = toy_study("runs=1", "grid.collaboration.n=[1]", grid)
    made = run(study)
    [(failed, cause)] = made.failed.items()
    assert "ZeroDivisionError: not sound" in cause
    assert made.left == [failed]
    assert len(made.rows) == 1
    assert run(study).failed == made.failed  # not repeated
    sound.touch()
    retried = run(study, retry=True)
    assert (retried.failed, len(retried.rows)) == ({}, 2)


def test_a_failure_shows_the_hint_of_its_error(run: Callable[..., StudyResult], few: Study) -> None:
    first, _ = few.planned(run(stop=lambda: True).directory)
    first.directory.mkdir(parents=True)
    (first.directory / "letter").touch()
    [(failed, cause)] = run().failed.items()
    assert failed == first
    error, hint = cause.splitlines()
    assert error.startswith(f"{first.directory}: ")
    assert hint == f"  {REMEDY}"


def test_a_stop_leaves_the_rest_for_the_next_time(run: Callable[..., StudyResult]) -> None:
    notes = Notes()
    stopped = run(watcher=notes, stop=lambda: bool(notes.started))
    assert len(notes.started) == 1
    assert len(stopped.left) == 2 - len(stopped.rows)
    assert stopped.left
    assert run().left == []


@pytest.mark.parametrize("asked", [False, True])
def test_an_interrupt_writes_the_rows_and_is_raised_unless_a_stop_is_requested(
    run: Callable[..., StudyResult], tmp_path: Path, asked: bool
) -> None:
    class Impatient(Notes):
        def on_run_ended(self, planned: Planned, end: End) -> None:
            super().on_run_ended(planned, end)
            raise KeyboardInterrupt

    notes = Impatient()

    def stop() -> bool:
        return asked and bool(notes.ends)

    if asked:
        assert len(run(watcher=notes, stop=stop).rows) == 1
    else:
        with pytest.raises(KeyboardInterrupt):
            run(watcher=notes, stop=stop)
    assert len(read_rows(tmp_path / "there" / "rows.csv")) == 1


def test_rows_of_another_session_count_as_finished(run: Callable[..., StudyResult], tmp_path: Path) -> None:
    made = run()
    notes = Notes()
    imported = run(out=tmp_path / "elsewhere", tables=[made.directory / "rows.csv"], watcher=notes)
    assert (notes.done, notes.started) == (2, [])
    assert {status.state for status in imported.statuses.values()} == {"imported"}
    assert imported.finished == {}
    assert [row.score for row in imported.rows.values()] == [row.score for row in made.rows.values()]


def test_results_of_different_bit_generations_are_named_before_any_run(
    run: Callable[..., StudyResult], few: Study, caplog: pytest.LogCaptureFixture
) -> None:
    made = run()
    [first, _] = made.rows
    config = first.directory / "config.toml"
    changed = "[provenance]\nbit_generations = {'populations.a.evolver' = 2}\n"
    config.write_text(config.read_text().replace("[provenance]\n", changed))
    assert not caplog.records
    again = run()
    plan_study(few, out=made.directory)
    assert [record.levelname for record in caplog.records] == ["WARNING", "WARNING"]
    for record in caplog.records:
        assert "(populations.a.evolver 'toy-drift': 1 and 2)" in record.message
    assert [row.bit_generations for row in again.rows.values()] == ["populations.a.evolver=2", ""]
    assert [row.bit_generation("populations.a.evolver") for row in again.rows.values()] == [2, 1]


def test_the_directory_of_something_else_is_refused(run: Callable[..., StudyResult], tmp_path: Path) -> None:
    (tmp_path / "letters").mkdir()
    (tmp_path / "letters" / "letter").touch()
    with pytest.raises(InputError, match="not empty") as caught:
        run(out=tmp_path / "letters")
    assert caught.value.source == str(tmp_path / "letters")
    assert STUDY_FILE in caught.value.problem


def test_a_study_that_was_read_takes_no_settings(few: Study) -> None:
    with pytest.raises(TypeError, match="read_study"):
        run_study(few, runs=3)


class TestPlan:
    def test_lists_the_runs_to_execute_and_writes_nothing(
        self, run: Callable[..., StudyResult], few: Study, toy_study: Read, tmp_path: Path
    ) -> None:
        planned = plan_study(few, out=tmp_path / "there")
        assert len(planned.to_run) == 2
        assert planned.estimate.bound == "at most"
        assert not (tmp_path / "there").exists()
        run()
        before = {path: path.stat().st_mtime_ns for path in (tmp_path / "there").rglob("*")}
        more = plan_study(toy_study("runs=2", "grid.collaboration.n=[1]"), out=tmp_path / "there", workers=1)
        assert (len(more.found.rows), len(more.to_run), more.cores) == (2, 2, 1)
        assert more.estimate.measured.startswith("2 ")
        assert more.estimate.bound == "about"
        assert {path: path.stat().st_mtime_ns for path in (tmp_path / "there").rglob("*")} == before

    def test_counts_failed_runs_on_request(
        self, run: Callable[..., StudyResult], few: Study, tmp_path: Path
    ) -> None:
        failed, _ = few.planned(run(stop=lambda: True).directory)
        failed.directory.mkdir(parents=True)
        (failed.directory / FAILURE_FILE).write_text('{"cause": "a fault"}')
        assert len(plan_study(few, out=tmp_path / "there").to_run) == 1
        assert len(plan_study(few, out=tmp_path / "there", retry=True).to_run) == 2

    def test_takes_settings_as_run_does(self) -> None:
        dotted: dict[str, Any] = {"run.generations": 3, "grid.aggregator": ["am"]}
        planned = plan_study("small", runs=2, **dotted)
        assert planned.found.directory == Path("studies/small")
        assert len(planned.to_run) == 4
        assert planned.to_run[0].cell.config.run.generations == 3

    def test_has_whole_runs_on_each_core(self, toy_study: Read, tmp_path: Path) -> None:
        planned = plan_study(toy_study("runs=3", "grid={collaboration.n=[1]}"), out=tmp_path / "there")
        core_time = planned.estimate.seconds
        for cores, share in ((1, 1), (2, 2 / 3), (3, 1 / 3)):
            assert attrs.evolve(planned, cores=cores).seconds == pytest.approx(core_time * share)
        assert attrs.evolve(planned, to_run=()).seconds == 0.0

    def test_takes_a_whole_grid_in_place_of_that_of_the_study(self) -> None:
        planned = plan_study("small", runs=2, grid={"aggregator": ["hm"]})
        assert planned.found.study.grid == {"aggregator": ("hm",)}
        assert len(planned.to_run) == 2


def test_the_python_of_the_page_on_studies_runs(tmp_path: Path) -> None:
    [block] = re.findall(r"```python\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    (tmp_path / "mine.py").write_text(block)
    ran = python("mine.py", directory=tmp_path)
    assert ran.returncode == 0, ran.stderr
    assert len(ran.stdout.splitlines()) == 9
    assert len(read_rows(tmp_path / "studies" / "few" / "rows.csv")) == 8
