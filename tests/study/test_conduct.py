"""The directory of a study, shared by several processes."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Future
from pathlib import Path

import attrs
import pytest

from evoframe import InputError
from evoframe.messages import full_text
from evoframe.record import open_run
from evoframe.record.database import Database, Table
from evoframe.study import gathered, progress
from evoframe.study.conduct import STUDY_FILE, Watcher, claim, execute, lock_tables, refuse_another, survey
from evoframe.study.gathered import gather
from evoframe.study.plan import Planned, Study
from evoframe.study.pool import End, News, Pool
from evoframe.study.progress import REMEDY, Status, record_failure, status_of
from evoframe.study.worker import Order

Read = Callable[..., Study]


def test_leftovers_of_another_process_that_is_claiming_the_directory_are_ignored(
    toy_study: Read, tmp_path: Path
) -> None:
    there = tmp_path / "there"
    there.mkdir()
    with lock_tables(there):
        (there / f".{STUDY_FILE}.new").write_text("half")
        refuse_another(toy_study(), there)
    claim(toy_study(), there)
    assert (there / STUDY_FILE).is_file()


def test_a_directory_claimed_during_the_check_belongs_to_the_study(
    toy_study: Read, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    study, there = toy_study(), tmp_path / "there"
    there.mkdir()
    look = Path.iterdir

    def claimed_meanwhile(path: Path) -> object:
        with monkeypatch.context() as patch:
            patch.setattr(Path, "iterdir", look)
            claim(study, there)
        return look(path)

    monkeypatch.setattr(Path, "iterdir", claimed_meanwhile)
    refuse_another(study, there)


def test_a_file_with_the_same_values_keeps_its_comments(toy_study: Read, tmp_path: Path) -> None:
    path = tmp_path / "there" / STUDY_FILE
    claim(toy_study(), path.parent)
    text = f"# mine\n{path.read_text()}"
    path.write_text(text)
    claim(toy_study(), path.parent)
    assert path.read_text() == text
    claim(toy_study("runs=4"), path.parent)
    assert "runs = 4" in path.read_text()


def test_the_directory_of_something_else_stays_unchanged(toy_study: Read, tmp_path: Path) -> None:
    (tmp_path / "there").mkdir()
    (tmp_path / "there" / "letter").touch()
    with pytest.raises(InputError, match="not empty") as caught:
        claim(toy_study(), tmp_path / "there")
    assert caught.value.source == str(tmp_path / "there")
    assert STUDY_FILE in caught.value.problem
    assert [path.name for path in (tmp_path / "there").iterdir()] == ["letter"]


@pytest.mark.parametrize(
    ("fewer", "lines"),
    [
        (("runs=1",), [("runs: ", "3", "1")]),
        (("grid.collaboration.n=[2]",), [("grid.collaboration.n: ", "1")]),
        (("runs=2", "grid.simulator=['toy-product']"), [("runs: ", "3", "2"), ("grid.simulator: {",)]),
    ],
)
def test_a_study_is_not_made_smaller(
    toy_study: Read, tmp_path: Path, fewer: tuple[str, ...], lines: list[tuple[str, ...]]
) -> None:
    there = tmp_path / "there"
    claim(toy_study(), there)
    before = (there / STUDY_FILE).read_bytes()
    with pytest.raises(InputError) as caught:
        claim(toy_study(*fewer), there)
    assert caught.value.source == str(there / STUDY_FILE)
    first, *listed = caught.value.problem.splitlines()
    assert "--out" in first
    for line, (start, *numbers) in zip(listed, lines, strict=True):
        assert line.strip().startswith(start)
        assert re.findall(r"\d+", line)[: len(numbers)] == numbers
    assert (there / STUDY_FILE).read_bytes() == before
    claim(toy_study("runs=4", "grid.collaboration.n=[1, 2, 3]"), there)


class Workers(Pool):
    """A replacement for a pool whose runs end in pairs, as soon as both have started."""

    def __init__(self, workers: int, ends: Mapping[int, End]) -> None:
        self.workers = workers
        self.ends = ends
        self.started: list[Order] = []
        self.at_once = 0
        self.stopping = False
        self._running: list[Future[End]] = []

    def start(self, order: Order) -> Future[End]:
        self.started.append(order)
        self._running.append(Future())
        self.at_once = max(self.at_once, sum(not future.done() for future in self._running))
        if len(self._running) % 2 == 0:  # two start, and then both end
            for future, number in zip(self._running[-2:], (-2, -1), strict=True):
                future.set_result(self.ends.get(len(self._running) + number, End("finished")))
        return self._running[-1]

    def news(self) -> Iterator[News]:
        yield self.started[-1].directory, 1, 2.5
        yield Path("nowhere"), 1, 3.5

    def request_stop(self) -> None:
        self.stopping = True
        for future in self._running:
            if not future.done():
                future.set_result(End("stopped"))


@attrs.define
class Notes(Watcher):
    """A watcher that records what it receives."""

    events: list[tuple[str, Planned]] = attrs.field(factory=list)
    ends: list[End] = attrs.field(factory=list)

    def on_run_started(self, planned: Planned) -> None:
        self.events.append(("started", planned))

    def on_turn_finished(self, planned: Planned, turn: int, best: float | None) -> None:
        assert (turn, best) == (1, 2.5)
        self.events.append(("progress", planned))

    def on_run_ended(self, planned: Planned, end: End) -> None:
        self.events.append(("ended", planned))
        self.ends.append(end)


@pytest.fixture
def orders(toy_study: Read, tmp_path: Path) -> dict[Planned, Order]:
    study = toy_study("runs=1")
    return {
        run: Order(run.directory, study.layers_of(run), study.label, ())
        for run in study.planned(tmp_path / "there")
    }


class TestWork:
    def test_is_done_in_order_by_all_workers(self, orders: dict[Planned, Order]) -> None:
        workers, notes = Workers(2, {}), Notes()
        execute(orders, workers, notes, lambda: False)
        assert workers.started == list(orders.values())
        assert workers.at_once == 2
        assert [run for event, run in notes.events if event == "started"] == list(orders)
        assert {run for event, run in notes.events if event == "ended"} == set(orders)
        for run in list(orders)[1::2]:
            assert notes.events.index(("started", run)) < notes.events.index(("progress", run))
            assert notes.events.index(("progress", run)) < notes.events.index(("ended", run))

    def test_that_failed_is_recorded_and_stops_no_other(self, orders: dict[Planned, Order]) -> None:
        first, *others = orders
        record_failure(others[0].directory, "a fault of yesterday")
        workers, notes = Workers(2, {0: End("failed", "a fault")}), Notes()
        execute(orders, workers, notes, lambda: False)
        assert status_of(first) == Status("failed", "a fault")
        assert len(workers.started) == 4
        assert {status_of(run).state for run in others} == {"missing"}

    def test_stops_after_the_runs_in_progress(self, orders: dict[Planned, Order]) -> None:
        workers, notes = Workers(1, {}), Notes()
        asked = iter([False, True, True, True])
        execute(orders, workers, notes, lambda: next(asked))
        assert workers.stopping
        assert len(workers.started) == 1
        assert notes.ends == [End("stopped")]


def test_an_error_about_a_damaged_run_has_a_hint(made: tuple[Study, Path, list[Planned]]) -> None:
    study, directory, planned = made
    (planned[2].directory / "run.db").write_bytes(b"x" * 4096)
    with pytest.raises(InputError, match=r"run\.db: ") as caught:
        survey(study, directory)
    assert full_text(caught.value).endswith(f"\n  {REMEDY}")


def test_a_finished_run_is_opened_once_for_its_status_and_its_row(
    made: tuple[Study, Path, list[Planned]], monkeypatch: pytest.MonkeyPatch
) -> None:
    study, directory, planned = made
    opened: list[Path] = []
    tables: list[str] = []
    read = Database.read

    def noted(directory: Path) -> object:
        opened.append(directory)
        return open_run(directory)

    def noted_table(database: Database, name: str) -> Table:
        tables.append(name)
        return read(database, name)

    monkeypatch.setattr(progress, "open_run", noted)
    monkeypatch.setattr(gathered, "open_run", noted)
    monkeypatch.setattr(Database, "read", noted_table)
    statuses = survey(study, directory, rows=True)
    rows = gather(statuses, {})
    assert opened == [run.directory for run in planned]
    assert set(tables).isdisjoint({"individuals", "pairs"})  # the large ones
    assert list(rows) == planned
    assert gather(survey(study, directory), {}) == rows
    assert survey(study, directory, known=statuses) == statuses
    assert len(opened) == 3 * len(planned)
