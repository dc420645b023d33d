"""Execution of runs by the worker processes of a study."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import toys

import evoframe
from evoframe import Plugins, RunConfig, assemble, load_run
from evoframe.config.resolve import resolve_layers
from evoframe.errors import LockedError, NotEmptyError
from evoframe.files.locks import locked
from evoframe.messages import full_text
from evoframe.record import open_run
from evoframe.record.layout import VERIFICATION_FILE
from evoframe.runs.execution import Execution
from evoframe.runs.starting import prepare
from evoframe.study import worker
from evoframe.study.plan import Planned, Study
from evoframe.study.progress import REMEDY
from evoframe.study.worker import Channel, Order, _Reporter, perform

Read = Callable[..., Study]
SILENT = Channel(lambda _, __: None, lambda: False, lambda: None)


@pytest.fixture
def planned(toy_study: Read, tmp_path: Path) -> tuple[Study, Planned]:
    """The first run of toys whose champion can be verified."""
    study = toy_study()
    return study, list(study.planned(tmp_path / "here"))[1]


@pytest.fixture
def order(planned: tuple[Study, Planned], toy_plugins: Plugins, monkeypatch: pytest.MonkeyPatch) -> Order:
    study, run = planned
    monkeypatch.setattr(worker, "discover", lambda _: toy_plugins)
    return Order(run.directory, study.layers_of(run), study.label, (toys.__file__,))


def meanwhile(monkeypatch: pytest.MonkeyPatch, first: Callable[[RunConfig, Path], object]) -> None:
    """Call *first* after the check that a run has not started, and before it starts."""

    def prepared(config: RunConfig, plugins: Plugins, out: Path) -> Execution:
        first(config, out)
        return prepare(config, plugins, out)

    monkeypatch.setattr(worker, "prepare", prepared)


def test_remains_of_a_damaged_run_are_refused(order: Order) -> None:
    order.directory.mkdir(parents=True)
    (order.directory / "champion.vxa").touch()
    with pytest.raises(NotEmptyError, match="not empty") as caught:
        perform(order, SILENT)
    assert caught.value.source == str(order.directory)
    assert full_text(caught.value).endswith(f"\n  {REMEDY}")


def test_a_run_that_another_process_has_finished_meanwhile_is_finished(
    order: Order, monkeypatch: pytest.MonkeyPatch
) -> None:
    def finish(config: RunConfig, out: Path) -> None:
        evoframe.run(config, out=out)

    meanwhile(monkeypatch, finish)
    assert perform(order, SILENT)
    assert load_run(order.directory).resumes() == []


def test_a_run_that_another_process_has_started_meanwhile_is_left_to_it(
    order: Order, monkeypatch: pytest.MonkeyPatch
) -> None:
    others: list[Any] = []
    meanwhile(monkeypatch, lambda config, out: others.append(prepare(config, Plugins(), out)))
    with pytest.raises(LockedError):
        perform(order, SILENT)
    others[0].play()
    assert load_run(order.directory).finished()


def test_a_run_whose_directory_another_process_has_just_locked_is_left_to_it(
    order: Order,
) -> None:
    order.directory.mkdir(parents=True)
    with locked(order.directory), pytest.raises(LockedError) as caught:
        perform(order, SILENT)
    assert full_text(caught.value) == str(caught.value)  # no hint: the run is not damaged
    assert perform(order, SILENT)


@pytest.mark.parametrize("finished", [False, True])
def test_a_run_begins_once_it_is_open(order: Order, *, finished: bool) -> None:
    if finished:
        assert perform(order, SILENT)
    begun: list[bool] = []

    def begin() -> None:
        with open_run(order.directory) as run:
            begun.append(run.finished())

    assert (perform(order, Channel(lambda _, __: None, lambda: True, begin)) is not None) == finished
    assert begun == [finished]


def test_a_finished_run_is_only_verified_and_only_once(order: Order) -> None:
    assert perform(order, SILENT)
    verification = order.directory / VERIFICATION_FILE
    made, database = verification.read_bytes(), (order.directory / "run.db").read_bytes()
    verification.unlink()
    with locked(order.directory), pytest.raises(LockedError):  # another process is verifying it
        perform(order, SILENT)
    assert perform(order, SILENT)
    assert verification.read_bytes() == made
    assert (order.directory / "run.db").read_bytes() == database
    with locked(order.directory):
        assert perform(order, SILENT)


@pytest.mark.parametrize(("pace", "turns"), [(0.0, [0]), (0.1, [0, 3, 6]), (1.0, [*range(9)])])
def test_turns_are_reported_at_most_once_per_interval(
    order: Order, toy_plugins: Plugins, monkeypatch: pytest.MonkeyPatch, pace: float, turns: list[int]
) -> None:
    clock = itertools.count()
    monkeypatch.setattr("time.monotonic", lambda: next(clock) * pace)
    reported: list[tuple[int, float | None]] = []
    reporter = _Reporter(
        Channel(lambda turn, best: reported.append((turn, best)), lambda: False, lambda: None)
    )
    finished, best = [], None
    for turn in assemble(resolve_layers(order.layers, order.label, toy_plugins)):
        reporter.evoframe_turn_finished(turn)
        best = turn.best_pair.score if turn.best_pair else best
        finished.append((turn.index, best))
    assert reported == [finished[turn] for turn in turns]
