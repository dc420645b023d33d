"""Components that fail: the run says whose fault it is, stops, and goes on when it is mended."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import attrs
import numpy as np
import pytest
import toys
from recorded import assert_same_result

from evoframe import Member, Outcome, Plugins, RunConfig, RunError, load_run, resume, run
from evoframe.messages import full_text

Load = Callable[..., RunConfig]


def raises(*_: Any) -> Any:
    raise ZeroDivisionError("oops")


def outcome(value: Any, steps: int = 1) -> Outcome:
    return Outcome(np.zeros(steps, dtype=np.int64), np.zeros(steps), {"value": value})


def giving(value: Any) -> Callable[..., Any]:
    """Return a method that gives *value*, whatever it is asked."""
    return lambda *_: value


def outcomes(value: Any, steps: int = 1) -> Callable[..., Any]:
    return lambda self, designs, record: [outcome(value, steps)] * len(designs)


def diverged_at(step: Any) -> Callable[..., Any]:
    return lambda self, designs, record: [
        attrs.evolve(outcome(np.ones((1, 3))), diverged_at=step) for _ in designs
    ]


def strangers(run: toys.DriftRun) -> list[Member]:
    return [Member(id=i, fitness=None, age=1.5) for i in run.ids]  # type: ignore[arg-type]


def shortened(method: Callable[..., Any]) -> Callable[..., Any]:
    return lambda *arguments: method(*arguments)[:-1]


def unchanged(_: Any, network: Any, design: Any) -> Any:
    del network
    return design


A, B, OOPS = r"populations\.a\.encoder: ", r"populations\.a\.evolver: ", "ZeroDivisionError: oops"
PAIR = r"\(turn 0, a 1 with b 1; a 1 with b 2"
VALUE = "the track 'value'"
ENDLESS = outcomes(np.full((1, 3), np.nan))
FAULTS = [
    (toys.Product, "simulate", raises, rf"simulator: 'toy-product' \(.*\): {OOPS} {PAIR}"),
    (toys.Product, "simulate", giving([]), rf"simulator: .*: returned 0 outcomes for \d designs {PAIR}"),
    (toys.Product, "simulate", giving(None), "simulator: .*: TypeError: 'NoneType' object is not iterable"),
    (toys.Product, "simulate", giving([7] * 4), "simulator: .*: returned no Outcome, but int"),
    (toys.Product, "simulate", outcomes([1.0]), f"simulator: .*: returned no array for {VALUE}"),
    (toys.Product, "simulate", outcomes(np.ones((1, 3)), 2), f"returned 1 samples of {VALUE} for 2 steps"),
    (toys.Product, "simulate", ENDLESS, f"returned numbers that are not finite in {VALUE}, but had not div"),
    (toys.Product, "simulate", diverged_at("late"), "simulator: .*: says that it diverged at step 'late'"),
    (toys.Product, "key", raises, f"simulator: .*: {OOPS}"),
    (toys.Product, "key", giving("text"), "simulator: .*: gave a key that is no bytes, but str"),
    (toys.Number, "decode", raises, rf"{A}'toy-number' .*{OOPS} \(turn 0, a 1\)"),
    (toys.Number, "decode", unchanged, rf"{A}.*: left out the role 'a' \(turn 0, a 1\)"),
    (
        toys.Number,
        "decode",
        giving(None),
        rf"{A}.*AttributeError: 'NoneType' object has no attribute 'roles'",
    ),
    (toys.DriftRun, "ask", raises, rf"{B}'toy-drift' .*{OOPS} \(turn 0\)"),
    (toys.DriftRun, "ask", shortened(toys.DriftRun.ask), rf"{B}.*: gave 5 genomes and 6 members"),
    (toys.DriftRun, "tell", raises, rf"{B}.*{OOPS}"),
    (toys.DriftRun, "express", raises, rf"{B}.*{OOPS} \(turn 0, a 1\)"),
    (toys.DriftRun, "members", strangers, rf"{B}.*: gave a member with 1\.5 where an integer belongs"),
    (
        toys.DriftRun,
        "dump",
        giving(np.float32(1)),
        rf"{B}.*TypeError: Object of type float32 is not JSON",
    ),
    (toys.DriftRun, "dump", raises, rf"{B}.*{OOPS} \(turn 0, a \d+\)"),
    (toys.DriftRun, "state", raises, rf"{B}.*{OOPS}"),
    (toys.DriftRun, "state", giving({"x": float("inf")}), rf"{B}.*: its state cannot be saved as JSON"),
    (toys.DriftRun, "state", giving({1, 2}), rf"{B}.*: its state cannot be saved as JSON"),
    (toys.First, "select", raises, rf"collaboration: 'toy-first' .*{OOPS} \(turn 1\)"),
    (toys.First, "select", giving("ab"), "collaboration: .*: chose ab, not 2 of the 5 members of 'b'"),
    (toys.Mean, "aggregate", raises, rf"aggregator: 'toy-mean' .*{OOPS} \(turn 1, a \d+\)"),
    (toys.Mean, "aggregate", giving("good"), r"aggregator: .*: gave the fitness 'good' for the scores \["),
    (toys.Value, "score", raises, rf"objective: 'toy-value' .*{OOPS} {PAIR}"),
    (toys.Value, "score", giving(None), rf"objective: .*: gave the score None for a simulation .* {PAIR}"),
]


@pytest.mark.parametrize(("component", "method", "fault", "message"), FAULTS)
def test_is_named_with_all_that_is_known(
    toy_config: Load,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    component: type[Any],
    method: str,
    fault: Any,
    message: str,
) -> None:
    monkeypatch.setattr(component, method, fault)
    with pytest.raises(RunError, match=message) as caught:
        run(toy_config(), out=tmp_path / "run")
    assert "of toy-box 1.0" in str(caught.value)
    assert f"evoframe resume {tmp_path / 'run'}" in full_text(caught.value)


@pytest.mark.parametrize(
    ("component", "method", "call"),
    [
        (toys.Product, "simulate", 17),
        (toys.Number, "decode", 80),
        (toys.DriftRun, "state", 6),
        (toys.Mean, "aggregate", 17),
    ],
)
def test_a_run_goes_on_when_the_plugin_is_mended(
    toy_config: Load,
    toy_plugins: Plugins,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    component: type[Any],
    method: str,
    call: int,
) -> None:
    undisturbed = run(toy_config(), out=tmp_path / "undisturbed")
    working, calls = getattr(component, method), [0]

    def failing_later(*arguments: Any) -> Any:
        calls[0] += 1
        return raises() if calls[0] == call else working(*arguments)

    with monkeypatch.context() as patch:
        patch.setattr(component, method, failing_later)
        with pytest.raises(RunError, match="ZeroDivisionError: oops"):
            run(toy_config(), out=tmp_path / "run")
    assert load_run(tmp_path / "run").last_turn() is not None
    resume(tmp_path / "run", plugins=toy_plugins)
    assert_same_result(undisturbed.directory, tmp_path / "run")


def test_numbers_of_numpy_are_numbers(
    toy_config: Load, toy_plugins: Plugins, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    undisturbed = run(toy_config("simulator={name='toy-product', limit=0.1}"), out=tmp_path / "undisturbed")
    assert any(pair["diverged_at"] == 1 for pair in undisturbed.pairs())
    working = toys.Product._outcome, toys.DriftRun.members

    def numpys_outcome(self: toys.Product, design: Any) -> Outcome:
        made = working[0](self, design)
        step: Any = None if made.diverged_at is None else np.int64(made.diverged_at)
        return attrs.evolve(made, diverged_at=step)

    def numpys_members(self: toys.DriftRun) -> list[Member]:
        integer: Any = np.int64
        return [attrs.evolve(m, id=integer(m.id), age=integer(m.age)) for m in working[1](self)]

    monkeypatch.setattr(toys.Product, "_outcome", numpys_outcome)
    monkeypatch.setattr(toys.DriftRun, "members", numpys_members)
    again = run(toy_config("simulator={name='toy-product', limit=0.1}"), out=tmp_path / "again")
    assert_same_result(undisturbed.directory, again.directory)


def test_an_executor_that_loses_results_is_named(
    toy_config: Load, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    working = toys.Here.map

    def forgetful(self: toys.Here, function: Any, items: Any) -> Any:
        return working(self, function, items)[:-1]

    monkeypatch.setattr(toys.Here, "map", forgetful)
    with pytest.raises(RunError, match=r"executor: 'toy-here' .*: did not return the results of all batches"):
        run(toy_config(), out=tmp_path / "run")
