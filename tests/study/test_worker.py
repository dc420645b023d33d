"""What a process of a study does with a run."""

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
from evoframe.record.layout import VERIFICATION_FILE
from evoframe.runs.execution import Execution
from evoframe.runs.starting import prepare
from evoframe.study import worker
from evoframe.study.plan import Planned, Study
from evoframe.study.worker import Order, Talk, _Teller, perform

Read = Callable[..., Study]
SILENT = Talk(lambda _, __: None, lambda: False)


@pytest.fixture
def planned(toy_study: Read, tmp_path: Path) -> tuple[Study, Planned]:
    """The first run of toys that can be verified."""
    study = toy_study()
    return study, list(study.planned(tmp_path / "here"))[1]


@pytest.fixture
def order(planned: tuple[Study, Planned], toy_plugins: Plugins, monkeypatch: pytest.MonkeyPatch) -> Order:
    study, run = planned
    monkeypatch.setattr(worker, "discover", lambda _: toy_plugins)
    return Order(run.directory, study.layers_of(run), study.label, (toys.__file__,))


def meanwhile(monkeypatch: pytest.MonkeyPatch, first: Callable[[RunConfig, Path], object]) -> None:
    """Let something happen after it was seen that a run has not begun."""

    def prepared(config: RunConfig, plugins: Plugins, out: Path) -> Execution:
        first(config, out)
        return prepare(config, plugins, out)

    monkeypatch.setattr(worker, "prepare", prepared)


def test_what_is_left_of_a_damaged_run_is_not_taken_for_one(order: Order) -> None:
    order.directory.mkdir(parents=True)
    (order.directory / "champion.vxa").touch()
    with pytest.raises(NotEmptyError, match="00: is not empty") as caught:
        perform(order, SILENT)
    assert full_text(caught.value).endswith(
        "00: is not empty\n  a run whose directory is removed is made again"
    )


def test_a_run_that_another_process_has_made_meanwhile_is_finished(
    order: Order, monkeypatch: pytest.MonkeyPatch
) -> None:
    def make(config: RunConfig, out: Path) -> None:
        evoframe.run(config, out=out)

    meanwhile(monkeypatch, make)
    assert perform(order, SILENT)
    assert load_run(order.directory).resumes() == []


def test_a_run_that_another_process_has_begun_meanwhile_is_left_to_it(
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
    assert full_text(caught.value) == str(caught.value)  # nothing is damaged
    assert perform(order, SILENT)


def test_a_finished_run_is_only_verified_and_only_once(order: Order) -> None:
    assert perform(order, SILENT)
    verification = order.directory / VERIFICATION_FILE
    made, database = verification.read_bytes(), (order.directory / "run.db").read_bytes()
    verification.unlink()
    with locked(order.directory), pytest.raises(LockedError):  # somebody verifies it just now
        perform(order, SILENT)
    assert perform(order, SILENT)
    assert verification.read_bytes() == made
    assert (order.directory / "run.db").read_bytes() == database
    with locked(order.directory):
        assert perform(order, SILENT)


@pytest.mark.parametrize(("pace", "turns"), [(0.0, [0]), (0.1, [0, 3, 6]), (1.0, [*range(9)])])
def test_turns_are_told_not_more_often_than_anybody_looks(
    order: Order, toy_plugins: Plugins, monkeypatch: pytest.MonkeyPatch, pace: float, turns: list[int]
) -> None:
    clock = itertools.count()
    monkeypatch.setattr("time.monotonic", lambda: next(clock) * pace)
    told: list[tuple[int, float | None]] = []
    teller = _Teller(Talk(lambda turn, best: told.append((turn, best)), lambda: False))
    made, best = [], None
    for turn in assemble(resolve_layers(order.layers, order.label, toy_plugins)):
        teller.evoframe_turn_finished(turn)
        best = turn.best_pair.score if turn.best_pair else best
        made.append((turn.index, best))
    assert told == [made[turn] for turn in turns]
