"""A whole run with toy components: its directory, its record and its observers."""

from __future__ import annotations

import json
import shutil
import statistics
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import toys
from modules import plugin
from recorded import assert_same_result, rows

import evoframe.record.store
from evoframe import (
    PluginWarning,
    RunConfig,
    RunError,
    Turn,
    load_run,
    run,
)
from evoframe.contract.config import Source
from evoframe.errors import ComponentError
from evoframe.files import writing
from evoframe.record.champion import read_champion
from evoframe.registry.registry import Plugins
from evoframe.runs.starting import prepare

Load = Callable[..., RunConfig]


class TestDirectory:
    def test_holds_configuration_database_and_champion(self, toy_config: Load, tmp_path: Path) -> None:
        finished = run(toy_config(), out=tmp_path / "run")
        assert sorted(path.name for path in finished.directory.iterdir()) == [
            "champion.json",
            "config.toml",
            "run.db",
            "run.lock",
        ]

    def test_the_recorded_configuration_gives_the_same_result_again(
        self, toy_config: Load, toy_plugins: Plugins, tmp_path: Path
    ) -> None:
        first = run(toy_config("run.seed=8"), out=tmp_path / "first")
        second = run(first.directory / "config.toml", out=tmp_path / "second", plugins=toy_plugins)
        assert_same_result(first.directory, second.directory)

    def test_has_a_row_for_each_turn_individual_and_pair(self, toy_config: Load, tmp_path: Path) -> None:
        finished = run(toy_config(), out=tmp_path / "run")
        assert len(finished.turns()) == 2 + 8
        assert len(finished.individuals()) == (6 + 5) + 4 * (6 + 5)
        assert len(finished.pairs()) == 30 + 4 * 2 * (6 + 5)
        assert [row["turn"] for row in finished.workload()] == list(range(9))
        assert {row["part"] for row in finished.table("state")} == {"loop", "population/a", "population/b"}

    def test_the_recorded_fitness_follows_from_the_recorded_scores(
        self, toy_config: Load, tmp_path: Path
    ) -> None:
        finished = run(toy_config("run.generations=10"), out=tmp_path / "run")
        for individual in finished.individuals():
            name, genome, turn = individual["population"], individual["genome_id"], individual["turn"]
            scores = [p["score"] for p in finished.pairs() if p["turn"] == turn and p[name] == genome]
            assert individual["fitness"] == pytest.approx(statistics.fmean(scores), rel=1e-12)

    def test_the_champion_is_the_best_pair_of_the_database(self, toy_config: Load, tmp_path: Path) -> None:
        finished = run(toy_config("run.generations=10"), out=tmp_path / "run")
        best = max(pair["score"] for pair in finished.pairs())
        assert finished.champion().score == best == finished.summary()["best_pair_score"]
        assert finished.table("best_pairs")[-1]["score"] == best
        roles = finished.champion().design.roles
        assert roles["a"][0] * roles["b"][0] == best

    def test_the_summary_names_the_fittest(self, toy_config: Load, tmp_path: Path) -> None:
        finished = run(toy_config(), out=tmp_path / "run")
        last = {row["population"]: row for row in finished.turns()}
        for name, fittest in finished.summary()["fittest"].items():
            assert fittest["fitness"] == last[name]["best"]
        assert finished.summary()["turns"] == 8

    def test_the_champion_file_names_nothing_of_this_machine(self, toy_config: Load, tmp_path: Path) -> None:
        finished = run(toy_config(), out=tmp_path / "a-name-to-find")
        text = (finished.directory / "champion.json").read_text()
        assert "a-name-to-find" not in text
        assert set(json.loads(text)) == {
            "format", "score", "turn", "genome_ids", "simulation", "design", "genomes",
        }  # fmt: skip

    def test_the_provenance_names_versions_and_distributions(self, toy_config: Load, tmp_path: Path) -> None:
        provenance = run(toy_config(), out=tmp_path / "run").config["provenance"]
        assert provenance["components"]["aggregator"] == "'toys' of toy-box 1.0"
        assert {"python", "numpy"} <= set(provenance["libraries"])

    def test_that_disappears_during_the_run_raises_run_error(self, toy_config: Load, tmp_path: Path) -> None:
        execution = prepare(toy_config(), Plugins(), tmp_path / "run")
        shutil.rmtree(tmp_path / "run")
        with pytest.raises(RunError, match=r"champion\.json: .*No such file"):
            execution.play()


def test_workers_are_shut_down(toy_config: Load, tmp_path: Path) -> None:
    before = len(toys.CLOSED)
    run(toy_config(), out=tmp_path / "run")
    assert len(toys.CLOSED) == before + 1


def test_a_kill_between_database_and_champion_file_loses_no_champion(
    toy_config: Load, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write = writing.write_json
    written: list[None] = []

    def killed(path: Path, document: Any) -> None:
        written.append(None)
        if len(written) >= 2:
            raise SystemExit("killed")
        write(path, document)

    monkeypatch.setattr(evoframe.record.store, "write_json", killed)
    monkeypatch.setattr(evoframe.record.store, "_SYNC_INTERVAL", 0.0)  # write the champion's files at once
    with pytest.raises(SystemExit):
        run(toy_config(), out=tmp_path / "run")
    killed_run = load_run(tmp_path / "run")
    assert killed_run.champion().score == max(pair["score"] for pair in killed_run.pairs())
    assert killed_run.champion().score > read_champion(tmp_path / "run" / "champion.json").score


class TestObservers:
    def test_receive_a_turn_only_after_it_was_saved(
        self, toy_config: Load, toy_plugins: Plugins, tmp_path: Path
    ) -> None:
        calls: list[Any] = []

        def started(directory: Path) -> None:
            calls.append("started")

        def turned(turn: Turn) -> None:
            calls.append((turn.index, len({row[0] for row in rows(tmp_path / "run", "turns")})))

        def finished(completed: bool) -> None:
            calls.append(completed)

        observer = plugin(
            evoframe_run_started=started, evoframe_turn_finished=turned, evoframe_run_finished=finished
        )
        toy_plugins.add(observer, Source("watcher", "1.0", "watch"))
        run(toy_config(), out=tmp_path / "run", plugins=toy_plugins)
        assert calls == ["started", *[(index, index + 1) for index in range(9)], True]

    @pytest.mark.parametrize("hook", ["run_started", "turn_finished", "run_finished"])
    def test_one_that_raises_does_not_change_the_result(
        self, toy_config: Load, toy_plugins: Plugins, tmp_path: Path, hook: str
    ) -> None:
        undisturbed = run(toy_config(), out=tmp_path / "undisturbed")

        def fail() -> None:
            raise OSError("no disk")

        toy_plugins.add(plugin(**{f"evoframe_{hook}": fail}), Source("watcher", "1.0", "watch"))
        with pytest.warns(PluginWarning, match="'watcher:watch' .*: OSError: no disk"):
            disturbed = run(toy_config(), out=tmp_path / "disturbed", plugins=toy_plugins)
        assert disturbed.pairs() == undisturbed.pairs()


def test_a_stopped_run_keeps_all_turns_and_is_not_finished(toy_config: Load, tmp_path: Path) -> None:
    calls: list[None] = []

    def stop() -> bool:
        calls.append(None)
        return len(calls) == 4

    execution = prepare(toy_config(), Plugins(), tmp_path / "run")
    assert not execution.play(stop).finished()
    stopped = load_run(tmp_path / "run")
    assert max(row["turn"] for row in stopped.turns()) == 3
    assert stopped.summary() == {}


def test_a_turn_is_saved_before_the_next_one_is_simulated(
    toy_config: Load, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With one worker; others simulate meanwhile."""
    simulate = toys.Product.simulate
    saved: list[int] = []

    def noting(self: toys.Product, *arguments: Any) -> Any:
        saved.append(len(rows(tmp_path / "run", "workload")))
        return simulate(self, *arguments)

    monkeypatch.setattr(toys.Product, "simulate", noting)
    finished = run(toy_config(), out=tmp_path / "run")
    simulated = [row["turn"] for row in finished.workload() if row["simulations"]]
    assert list(dict.fromkeys(saved)) == simulated


def test_a_turn_is_saved_if_the_next_one_fails_at_once(
    toy_config: Load, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    select = toys.First.select
    calls: list[None] = []

    def failing(self: toys.First, *arguments: Any) -> Any:
        calls.append(None)
        return select(self, *arguments) if len(calls) < 4 else "ab"

    monkeypatch.setattr(toys.First, "select", failing)
    with pytest.raises(ComponentError, match=r"turn 4"):
        run(toy_config(), out=tmp_path / "run")
    saved = load_run(tmp_path / "run")
    assert max(row["turn"] for row in saved.turns()) == max(row["turn"] for row in saved.table("state")) == 3


def test_every_turn_before_a_failed_reproduction_is_saved(
    toy_config: Load, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    ask = toys.DriftRun.ask
    calls: list[None] = []

    def failing(self: toys.DriftRun) -> Any:
        calls.append(None)
        if len(calls) == 5:  # two initial populations, then one in each turn
            raise ValueError("no offspring")
        return ask(self)

    monkeypatch.setattr(toys.DriftRun, "ask", failing)
    with pytest.raises(ComponentError, match=r"'toy-drift' .*no offspring.*turn 3"):
        run(toy_config(), out=tmp_path / "run")
    assert max(row["turn"] for row in load_run(tmp_path / "run").pairs()) == 2


def test_a_turn_and_its_state_are_saved_together_or_not_at_all(
    toy_config: Load, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    state = toys.DriftRun.state
    calls: list[None] = []

    def unsaveable(self: toys.DriftRun) -> Any:
        calls.append(None)
        return state(self) if len(calls) < 5 else {"not": float("nan")}

    monkeypatch.setattr(toys.DriftRun, "state", unsaveable)
    with pytest.raises(ComponentError, match=r"'toy-drift' .*turn 3") as caught:
        run(toy_config(), out=tmp_path / "run")
    assert caught.value.component.endswith(".evolver")
    saved = load_run(tmp_path / "run")
    last = max(row["turn"] for row in saved.turns())
    assert max(row["turn"] for row in saved.table("state")) == last
    assert max(row["turn"] for row in saved.pairs()) == last == 2
