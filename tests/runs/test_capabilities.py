"""Runs with every kind of timing, strategy, credit and role: their record, and resuming from it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
import toy_capabilities
from opening import reopened
from recorded import assert_same_result, rows
from toy_capabilities import VARIANTS

from evoframe import InputError, Run, RunConfig, load_run, resume, run
from evoframe.registry.registry import Plugins
from evoframe.runs.doctor import check_run
from evoframe.runs.starting import prepare

Variant = Callable[..., RunConfig]


@pytest.mark.parametrize("name", VARIANTS)
def test_a_run_that_is_stopped_after_each_turn_equals_an_uninterrupted_one(
    toy_variant: Variant, toy_plugins: Plugins, tmp_path: Path, name: str
) -> None:
    config, stopped = toy_variant(name), tmp_path / "stopped"
    whole = run(config, out=tmp_path / "whole", plugins=toy_plugins)
    played = prepare(config, toy_plugins, stopped).play(lambda: True)
    starts = 1
    while not played.finished():
        played = reopened(stopped, toy_plugins).play(lambda: True)
        starts += 1
    assert starts == len(whole.workload())
    assert_same_result(whole.directory, stopped)
    assert rows(whole.directory, "measures") == rows(stopped, "measures")


@pytest.mark.parametrize("name", VARIANTS)
def test_a_run_that_is_stopped_once_equals_an_uninterrupted_one(
    toy_variant: Variant, toy_plugins: Plugins, tmp_path: Path, name: str
) -> None:
    """Turns are saved while the next one is simulated; the last one is not."""
    config, stopped = toy_variant(name), tmp_path / "stopped"
    whole = run(config, out=tmp_path / "whole", plugins=toy_plugins)
    calls: list[None] = []

    def third() -> bool:
        calls.append(None)
        return len(calls) == 3

    prepare(config, toy_plugins, stopped).play(third)
    assert_the_doctor_is_content(stopped, toy_plugins)
    resume(stopped, plugins=toy_plugins)
    assert_same_result(whole.directory, stopped)


def assert_the_doctor_is_content(directory: Path, plugins: Plugins) -> None:
    checks = list(check_run(directory, plugins))
    assert [check.subject for check in checks] == [
        "format", "database", "configuration", "versions", "turns", "state", "champion",
    ]  # fmt: skip
    assert [check for check in checks if check.state != "ok"] == []


@pytest.mark.parametrize("name", VARIANTS)
def test_the_doctor_is_content_with_a_finished_run(
    toy_variant: Variant, toy_plugins: Plugins, tmp_path: Path, name: str
) -> None:
    run(toy_variant(name), out=tmp_path / "run", plugins=toy_plugins)
    assert_the_doctor_is_content(tmp_path / "run", toy_plugins)


@pytest.mark.parametrize("name", VARIANTS)
def test_the_recorded_configuration_gives_the_same_run(
    toy_variant: Variant, toy_plugins: Plugins, tmp_path: Path, name: str
) -> None:
    first = run(toy_variant(name), out=tmp_path / "first", plugins=toy_plugins)
    second = run(first.directory / "config.toml", out=tmp_path / "second", plugins=toy_plugins)
    assert_same_result(first.directory, second.directory)


class TestMeasures:
    @pytest.fixture
    def finished(self, toy_variant: Variant, tmp_path: Path, toy_plugins: Plugins) -> Run:
        return run(toy_variant("measures"), out=tmp_path / "run", plugins=toy_plugins)

    def test_have_a_row_for_each_that_an_evolver_wants(self, finished: Run) -> None:
        individuals = {(row["turn"], row["population"], row["position"]) for row in finished.individuals()}
        found: dict[str, set[str]] = {"a": set(), "b": set()}
        for row in finished.table("measures"):
            assert (row["turn"], row["population"], row["position"]) in individuals
            found[row["population"]].add(row["name"])
        assert found == {"a": {"novelty", "energy", "smallness"}, "b": {"size-of-a", "age"}}
        of_a = sum(row["population"] == "a" for row in finished.individuals())
        of_b = sum(row["population"] == "b" for row in finished.individuals())
        assert len(finished.table("measures")) == 3 * of_a + 2 * of_b

    def test_are_aggregated_like_scores(self, finished: Run) -> None:
        """The smallness of a pair is minus the absolute value of its score."""
        members = {
            (r["turn"], r["position"]): r["genome_id"]
            for r in finished.individuals()
            if r["population"] == "a"
        }
        checked = 0
        for row in finished.table("measures"):
            if row["name"] == "smallness":
                turn, genome = row["turn"], members[row["turn"], row["position"]]
                met = [-abs(p["score"]) for p in finished.pairs() if (p["turn"], p["a"]) == (turn, genome)]
                assert row["value"] == pytest.approx(sum(met) / len(met), rel=1e-12)
                checked += 1
        assert checked == len(members)

    def test_are_missing_from_runs_whose_evolvers_want_none(
        self, toy_variant: Variant, tmp_path: Path, toy_plugins: Plugins
    ) -> None:
        finished = run(toy_variant("sequential"), out=tmp_path / "run", plugins=toy_plugins)
        assert finished.table("measures") == []


class TestState:
    def test_has_a_part_for_each_memory(
        self, toy_variant: Variant, tmp_path: Path, toy_plugins: Plugins
    ) -> None:
        finished = run(toy_variant("own strategies"), out=tmp_path / "run", plugins=toy_plugins)
        parts = {row["part"] for row in finished.table("state")}
        assert parts == {"loop", "population/a", "population/b", "collaboration/a", "collaboration/b"}

    def test_of_a_role_is_compared_on_a_resume(
        self, toy_variant: Variant, tmp_path: Path, toy_plugins: Plugins, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        config = toy_variant("one", "roles.fixed={provider={name='toy-constant', role='z', value=3.0}}")
        prepare(config, toy_plugins, tmp_path / "run").play(lambda: True)
        monkeypatch.setattr(toy_capabilities.Constant, "restore", refuse)
        with pytest.raises(InputError, match=r"roles\.fixed\.provider: 'toy-constant' \(plugin .* was 3\.0"):
            resume(tmp_path / "run", plugins=toy_plugins)

    def test_that_a_strategy_refuses_is_named_with_it(
        self, toy_variant: Variant, tmp_path: Path, toy_plugins: Plugins, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        def refusing(self: object, state: object) -> None:
            raise ValueError("not my memory")

        prepare(toy_variant("own strategies"), toy_plugins, tmp_path / "run").play(lambda: True)
        monkeypatch.setattr(toy_capabilities.ArchivingRun, "restore", refusing)
        expected = r"populations\.b\.collaboration: 'toy-archiving' \(plugin .*not my memory.*after turn 0"
        with pytest.raises(InputError, match=expected) as caught:
            resume(tmp_path / "run", plugins=toy_plugins)
        assert caught.value.key == "state"
        assert load_run(tmp_path / "run").summary() == {}


def refuse(_: object, state: object) -> None:
    raise ValueError(f"the number was {state}")
