"""Components that fail: the run stops, names the component, and can be resumed after a fix."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import attrs
import numpy as np
import pytest
import toy_capabilities as caps
import toys
from recorded import assert_same_result

from evoframe import InputError, Member, Outcome, Plugins, RunConfig, load_run, resume, run
from evoframe.errors import ComponentError
from evoframe.messages import full_text
from evoframe.runs.starting import prepare

Load = Callable[..., RunConfig]


def raises(*_: Any) -> Any:
    raise ZeroDivisionError("oops")


def outcome(value: Any, steps: int = 1) -> Outcome:
    return Outcome(np.zeros(steps, dtype=np.int64), np.zeros(steps), {"value": value})


def giving(value: Any) -> Callable[..., Any]:
    """Return a method that returns *value* for any arguments."""
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


def wrong_type(self: toys.Number, network: Any, design: Any) -> Any:
    del network
    return design.with_role(self.role, np.ones(1, np.float32))


OOPS, TRACK = "ZeroDivisionError: oops", "'value'"
PAIR, TURN, A = "turn 0, a 1 with b 1; a 1 with b 2", "turn 0$", "turn 0, a 1$"
ENCODER, EVOLVER = "populations.a.encoder", "populations.a.evolver"
ENDLESS = outcomes(np.full((1, 3), np.nan))
FAULTS = [
    (toys.Product, "simulate", raises, "simulator", OOPS, PAIR),
    (toys.Product, "simulate", giving([]), "simulator", "0", PAIR),
    (toys.Product, "simulate", giving(None), "simulator", "TypeError: 'NoneType'", ""),
    (toys.Product, "simulate", giving([7] * 4), "simulator", "Outcome int", ""),
    (toys.Product, "simulate", outcomes([1.0]), "simulator", f"array {TRACK}", ""),
    (toys.Product, "simulate", outcomes(np.ones((1, 3)), 2), "simulator", f"1 {TRACK} 2", ""),
    (toys.Product, "simulate", ENDLESS, "simulator", f"finite {TRACK}", ""),
    (toys.Product, "simulate", diverged_at("late"), "simulator", "'late'", ""),
    (toys.Product, "key", raises, "simulator", OOPS, ""),
    (toys.Product, "key", giving("text"), "simulator", "bytes str", ""),
    (toys.Number, "decode", raises, ENCODER, OOPS, A),
    (toys.Number, "decode", unchanged, ENCODER, "'a'", A),
    (toys.Number, "decode", giving(None), ENCODER, "AttributeError: 'NoneType' 'roles'", ""),
    (toys.DriftRun, "ask", raises, EVOLVER, OOPS, TURN),
    (toys.DriftRun, "ask", shortened(toys.DriftRun.ask), EVOLVER, "5 6", ""),
    (toys.DriftRun, "tell", raises, EVOLVER, OOPS, ""),
    (toys.DriftRun, "express", raises, EVOLVER, OOPS, A),
    (toys.DriftRun, "express", giving(raises), EVOLVER, OOPS, A),
    (toys.DriftRun, "members", strangers, EVOLVER, "1.5 integer", ""),
    (toys.DriftRun, "dump", giving(np.float32(1)), EVOLVER, "TypeError: float32", ""),
    (toys.DriftRun, "dump", raises, EVOLVER, OOPS, r"turn 0, a \d+$"),
    (toys.DriftRun, "state", raises, EVOLVER, OOPS, ""),
    (toys.DriftRun, "state", giving({"x": float("inf")}), EVOLVER, "JSON", ""),
    (toys.DriftRun, "state", giving({1, 2}), EVOLVER, "JSON", ""),
    (toys.First, "select", raises, "collaboration", OOPS, "turn 1, population a$"),
    (toys.First, "select", giving("ab"), "collaboration", "ab 2 5 'b'", ""),
    (toys.Mean, "aggregate", raises, "aggregator", OOPS, r"turn 1, a \d+$"),
    (toys.Mean, "aggregate", giving("good"), "aggregator", "'good' [", ""),
    (toys.Value, "score", raises, "objective", OOPS, PAIR),
    (toys.Value, "score", giving(None), "objective", "None", PAIR),
]
NAMES = {
    "simulator": "toy-product",
    ENCODER: "toy-number",
    EVOLVER: "toy-drift",
    "collaboration": "toy-first",
    "aggregator": "toy-mean",
    "objective": "toy-value",
}


@pytest.mark.parametrize(("component", "method", "fault", "key", "problem", "concerns"), FAULTS)
def test_a_failing_component_is_named_with_its_plugin_turn_and_individuals(
    toy_config: Load,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    component: type[Any],
    method: str,
    fault: Any,
    key: str,
    problem: str,
    concerns: str,
) -> None:
    monkeypatch.setattr(component, method, fault)
    with pytest.raises(ComponentError) as caught:
        run(toy_config(), out=tmp_path / "run")
    error = caught.value
    assert error.component == key
    assert error.offered == f"'{NAMES[key]}' (plugin 'toys' of toy-box 1.0)"
    assert all(word in error.problem for word in problem.split())
    assert re.match(concerns, error.concerns)
    assert str(error).startswith(f"{key}: {error.offered}: ")
    assert f"evoframe resume {tmp_path / 'run'}" in full_text(error)


RUN_A, CREDIT = "turn 1, population a$", "turn 0, population a$"
CAPABILITIES: list[tuple[str, type[Any], str, Any, str, str, str]] = [
    ("archive", caps.ArchivingRun, "choose", raises, "collaboration", OOPS, RUN_A),
    ("archive", caps.ArchivingRun, "choose", giving([[0, 0]] * 6), "collaboration", "[0, 0] 2 5 'b'", RUN_A),
    ("archive", caps.ArchivingRun, "choose", giving([]), "collaboration", "0 6", RUN_A),
    ("archive", caps.ArchivingRun, "observe", raises, "collaboration", OOPS, CREDIT),
    ("archive", caps.ArchivingRun, "state", giving({1}), "collaboration", "TypeError set", ""),
    ("archive", caps.Archiving, "start", raises, "collaboration", OOPS, "population a$"),
    ("own strategies", caps.Archiving, "start", raises, "populations.b.collaboration", OOPS, "population b$"),
    ("each", caps.Loyal, "select_each", raises, "collaboration", OOPS, RUN_A),
    ("each", caps.Loyal, "select_each", giving([[0, 9]] * 6), "collaboration", "[0, 9] 2 5 'b'", RUN_A),
    ("credit", toys.Share, "credit", raises, "populations.a.aggregator", OOPS, CREDIT),
    ("credit", toys.Share, "credit", giving([1.0]), "populations.a.aggregator", "(1,) (6,)", CREDIT),
    (
        "credit",
        toys.Share,
        "credit",
        giving([math.inf] * 6),
        "populations.a.aggregator",
        "inf",
        "turn 0, a 1$",
    ),
    ("measures", caps.Wanting, "start", raises, EVOLVER, OOPS, "$"),
    ("measures", caps.Second, "measure", raises, "objective", OOPS, PAIR[:20]),
    ("measures", caps.Second, "measure", giving({}), "objective", "None 'smallness'", PAIR[:20]),
    ("measures", caps.Typed, "measure", raises, ENCODER, OOPS, "turn 0, b 1$"),
    ("measures", caps.Typed, "measure", giving({}), ENCODER, "KeyError 'size-of-a'", "turn 0, b 1$"),
    ("measures", caps.Typed, "decode", wrong_type, ENCODER, "provided float32[1] 'a' float64[1]", A),
    ("measures", caps.WantingRun, "tell", raises, EVOLVER, OOPS, "turn 0$"),
    ("one with a role for each", caps.Random, "fill", raises, "roles.r.provider", OOPS, A),
    ("one with a role for each", caps.Random, "fill", giving(None), "roles.r.provider", "AttributeError", A),
    ("one with a role for each", caps.Random, "start", raises, "roles.r.provider", OOPS, "$"),
    ("one with a role for each", caps.Random, "state", raises, "roles.r.provider", OOPS, "$"),
]


@pytest.mark.parametrize(
    ("variant", "component", "method", "fault", "key", "problem", "concerns"), CAPABILITIES
)
def test_a_failing_capability_is_named_with_its_plugin_turn_population_and_individuals(
    toy_variant: Load,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    variant: str,
    component: type[Any],
    method: str,
    fault: Any,
    key: str,
    problem: str,
    concerns: str,
) -> None:
    config = toy_variant(variant)
    monkeypatch.setattr(component, method, fault)
    with pytest.raises(ComponentError) as caught:
        run(config, out=tmp_path / "run")
    error, chosen = caught.value, dict(config.components())[key]
    assert error.component == key
    assert error.offered == f"'{chosen.name}' (plugin {chosen.source})"
    assert all(word in error.problem for word in problem.split()), error.problem
    assert re.match(concerns, error.concerns), error.concerns
    assert (f"evoframe resume {tmp_path / 'run'}" in full_text(error)) == (tmp_path / "run").exists()


def test_a_batch_size_that_fails_is_attributed_to_the_simulator(
    toy_variant: Load, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    config = toy_variant("measures")
    monkeypatch.setattr(caps.Measuring, "batch_size", property(raises))
    with pytest.raises(ComponentError, match=OOPS) as caught:
        run(config, out=tmp_path / "run")
    assert caught.value.component == "simulator"


@pytest.mark.parametrize(
    ("variant", "component", "key", "concerns"),
    [
        ("archive", caps.ArchivingRun, "collaboration", "population a"),
        ("archive", caps.WantingRun, EVOLVER, "a"),
        ("one with a role for each", caps.Random, "roles.r.provider", ""),
    ],
)
def test_a_component_that_cannot_be_restored_is_named(
    toy_variant: Load,
    toy_plugins: Plugins,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    variant: str,
    component: type[Any],
    key: str,
    concerns: str,
) -> None:
    config = toy_variant(variant)
    prepare(config, toy_plugins, tmp_path / "run").play(lambda: True)
    monkeypatch.setattr(component, "restore", raises)
    with pytest.raises(InputError) as caught:
        resume(tmp_path / "run", plugins=toy_plugins)
    chosen = dict(config.components())[key]
    where = ", ".join(part for part in ("state after turn 0", concerns) if part)
    expected = f"cannot be restored: {key}: '{chosen.name}' (plugin {chosen.source}): {OOPS} ({where})"
    assert (caught.value.problem, caught.value.key) == (expected, "state")
    assert caught.value.source == str(tmp_path / "run")


@pytest.mark.parametrize(
    ("component", "method", "call"),
    [
        (toys.Product, "simulate", 17),
        (toys.Number, "decode", 80),
        (toys.DriftRun, "state", 6),
        (toys.Mean, "aggregate", 17),
    ],
)
def test_a_run_can_be_resumed_after_the_plugin_is_fixed(
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
        with pytest.raises(ComponentError, match=OOPS):
            run(toy_config(), out=tmp_path / "run")
    assert load_run(tmp_path / "run").last_turn() is not None
    resume(tmp_path / "run", plugins=toy_plugins)
    assert_same_result(undisturbed.directory, tmp_path / "run")


def test_numpy_numbers_are_accepted(
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

    def losing(self: toys.Here, function: Any, items: Any) -> Any:
        return working(self, function, items)[:-1]

    monkeypatch.setattr(toys.Here, "map", losing)
    with pytest.raises(ComponentError) as caught:
        run(toy_config(), out=tmp_path / "run")
    assert caught.value.component == "executor"
    assert caught.value.offered.startswith("'toy-here' ")
