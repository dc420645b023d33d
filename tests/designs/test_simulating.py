"""Simulation of designs of files and runs: scores and positions of points."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import attrs
import pytest

from evoframe import Design, InputError, Plugins, RunConfig, Score, load_config, run
from evoframe.designs import Overlooked, overlooked, read_job, simulate_job, trace_of
from evoframe.evolution import evaluator_of
from evoframe_simulators import Vox

Load = Callable[..., RunConfig]


def test_a_champion_has_the_same_score_as_in_its_run(
    toy_config: Load, toy_plugins: Plugins, tmp_path: Path
) -> None:
    made = run(toy_config(), out=tmp_path / "run")
    job = read_job(made.directory, None, (), toy_plugins)
    assert [score.value for score in simulate_job(job)] == [made.champion().score]


def test_a_design_that_cannot_be_simulated_is_named_by_its_file(
    toy_config: Load, toy_plugins: Plugins, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    made = run(toy_config(), out=tmp_path / "run")
    job = read_job(made, None, (), toy_plugins)

    def refuses(*_: object) -> None:
        raise InputError("has no voxels")

    monkeypatch.setattr(type(job.config.simulator.component), "simulate", refuses)
    with pytest.raises(InputError, match="has no voxels") as caught:
        simulate_job(job)
    assert caught.value.source == str(made.directory)


class TestUnscored:
    def test_has_no_scores_but_the_steps_of_divergence(
        self, toy_config: Load, toy_plugins: Plugins, tmp_path: Path
    ) -> None:
        made = run(toy_config("simulator=toy-varied", "objective=toy-late"), out=tmp_path / "run")
        job = attrs.evolve(read_job(made, None, (), toy_plugins), unscored="ends too early")
        assert simulate_job(job) == [Score(None)]
        simulator: Any = job.config.simulator.component
        small = attrs.evolve(simulator, limit=0.0)
        chosen = attrs.evolve(job.config.simulator, component=small)
        diverging = attrs.evolve(job, config=attrs.evolve(job.config, simulator=chosen))
        assert simulate_job(diverging) == [Score(None, 1)]

    def test_has_the_divergences_of_whole_designs(
        self, toy_config: Load, toy_plugins: Plugins, tmp_path: Path
    ) -> None:
        made = run(toy_config("simulator={name='toy-shortsighted', torn_at=7}"), out=tmp_path / "run")
        job = read_job(made, None, (), toy_plugins)
        assert simulate_job(job) == [Score(made.champion().score)]
        assert simulate_job(attrs.evolve(job, unscored="ends too early")) == [Score(None, 7)]


class TestOverlooked:
    """The end of a simulation that the objective does not look at."""

    def test_is_the_longest_of_all_designs(self) -> None:
        config = load_config(overrides=["simulator.duration=0.25"])
        [*bodies] = [design for _, design in config.simulator.component.published()]  # type: ignore[attr-defined]
        scores = [Score(1.0, window=(0.003, 0.067)), Score(1.0, window=(0.003, 0.1)), Score(None, 3)]
        found = overlooked(config, bodies, scores)
        assert found is not None
        assert found.last == 0.067
        assert 0.25 <= found.end < 0.26
        assert str(found) == "looks at the first 0.067 s of 0.25 s"
        assert overlooked(config, bodies[2:], scores[2:]) is None

    def test_is_nothing_within_the_interval_of_the_samples(self) -> None:
        config = load_config()
        [_, body], *_ = config.simulator.component.published()  # type: ignore[attr-defined]
        evaluator = evaluator_of(config)
        [score] = evaluator.evaluate([body], 1)
        evaluator.close()
        assert overlooked(config, [body], [score]) is None
        finer = load_config(overrides=["objective.every=0.003"])
        assert overlooked(finer, [body], [score]) is not None

    def test_is_unknown_for_a_simulator_that_does_not_know_its_duration(self, toy_config: Load) -> None:
        scores = [Score(1.0, window=(0.0, 0.5))]
        assert overlooked(toy_config(), [Design()], scores) is None
        config = toy_config("simulator={name='toy-suggesting', duration=0.75}")
        assert overlooked(config, [Design()], scores) == Overlooked(0.5, 0.75)

    def test_is_nothing_if_the_times_differ_by_rounding(self, toy_config: Load) -> None:
        config = toy_config("simulator={name='toy-suggesting', duration=0.3}")
        for last in (0.3, 0.1 + 0.2, 0.3 * (1 - 1e-12)):
            assert overlooked(config, [Design()], [Score(1.0, window=(0.0, last))]) is None

    @pytest.mark.parametrize(
        ("last", "end", "text"),
        [
            (0.0673, 0.2505, "the first 0.067 s of 0.25 s"),
            (1.51, 1.54, "the first 1.51 s of 1.54 s"),
            (0.0, 30.0, "the first 0 s of 30 s"),
            (123.0, 125.0, "the first 123 s of 125 s"),
        ],
    )
    def test_is_shown_with_digits_that_differ(self, last: float, end: float, text: str) -> None:
        assert str(Overlooked(last, end)).endswith(text)


def test_a_trace_has_a_row_for_each_step_and_the_state_before_the_first() -> None:
    simulator = Vox(duration=0.001)
    [(_, body), *_] = simulator.published()
    design = Design({**body.roles})
    header, *rows = trace_of(simulator, design)
    assert header[:2] == ["step", "time"]
    assert header[2:] == [f"{name}_{axis}" for name in simulator.tracks for axis in "xyz"]
    assert [int(row[0]) for row in rows] == list(range(len(rows)))
    times = [float(row[1]) for row in rows]
    assert times[0] == 0.0
    assert times == sorted(times)
    assert all(len(row) == len(header) for row in rows)
