"""A run as a whole, with toys: its directory, its record, its observers."""

from __future__ import annotations

import concurrent.futures
import contextlib
import json
import shutil
import sqlite3
import statistics
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import toys
from hypothesis import given, strategies as st
from hypothesis.extra.numpy import array_shapes, arrays
from modules import plugin
from numpy.typing import NDArray
from recorded import assert_same_result, rows

import evoframe.record.store
from evoframe import (
    ConfigurationError,
    Design,
    InputError,
    PluginWarning,
    RunConfig,
    RunError,
    Turn,
    load_run,
    run,
)
from evoframe.contract.config import Source
from evoframe.files import writing
from evoframe.files.locks import acquire_lock
from evoframe.record.champion import design_from_json, design_to_json, read_champion
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

    def test_the_recorded_configuration_runs_again_to_the_same_end(
        self, toy_config: Load, toy_plugins: Plugins, tmp_path: Path
    ) -> None:
        first = run(toy_config("run.seed=8"), out=tmp_path / "first")
        second = run(first.directory / "config.toml", out=tmp_path / "second", plugins=toy_plugins)
        assert_same_result(first.directory, second.directory)

    def test_has_one_row_a_turn_an_individual_and_a_pair(self, toy_config: Load, tmp_path: Path) -> None:
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

    def test_the_summary_names_the_fittest_and_their_displacement(
        self, toy_config: Load, tmp_path: Path
    ) -> None:
        finished = run(toy_config(), out=tmp_path / "run")
        last = {row["population"]: row for row in finished.turns()}
        for name, fittest in finished.summary()["fittest"].items():
            assert fittest["fitness"] == last[name]["best"]
        assert finished.summary()["turns"] == 8

    def test_the_champion_file_has_nothing_of_this_machine(self, toy_config: Load, tmp_path: Path) -> None:
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

    def test_one_that_is_not_empty_is_refused_and_left_alone(self, toy_config: Load, tmp_path: Path) -> None:
        (tmp_path / "mine.txt").write_text("precious")
        with pytest.raises(InputError, match="is not empty; choose another directory with --out"):
            run(toy_config(), out=tmp_path)
        assert (tmp_path / "mine.txt").read_text() == "precious"
        assert not (tmp_path / "run.db").exists()

    def test_one_that_is_a_file_is_refused(self, toy_config: Load, toy_file: Path) -> None:
        with pytest.raises(InputError, match="cannot be used for a run"):
            run(toy_config(), out=toy_file)

    def test_the_default_one_counts_and_runs_that_start_together_have_each_their_own(
        self, toy_config: Load, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.chdir(tmp_path)
        config = toy_config()
        with concurrent.futures.ThreadPoolExecutor(8) as pool:
            finished = list(pool.map(lambda _: run(config), range(8)))
        names = sorted(str(one.directory) for one in finished)
        assert names == sorted(["runs/toy-3", *(f"runs/toy-3-{number}" for number in range(2, 9))])
        assert all(one.pairs() == finished[0].pairs() for one in finished)

    def test_belongs_to_one_run(self, toy_config: Load, tmp_path: Path) -> None:
        first = prepare(toy_config(), Plugins(), tmp_path / "run")
        with pytest.raises(InputError, match="is not empty"):
            prepare(toy_config(), Plugins(), tmp_path / "run")
        with pytest.raises(InputError, match="is being written by another process"):
            acquire_lock(tmp_path / "run")
        assert first.play().finished()

    def test_that_is_lost_in_the_middle_ends_the_run_in_a_sentence(
        self, toy_config: Load, tmp_path: Path
    ) -> None:
        execution = prepare(toy_config(), Plugins(), tmp_path / "run")
        shutil.rmtree(tmp_path / "run")
        with pytest.raises(RunError, match=r"champion\.json: cannot be written: No such file"):
            execution.play()


def test_a_directory_is_made_only_when_all_components_have_started(
    toy_config: Load, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuses(*_: Any) -> Any:
        raise ConfigurationError("no")

    monkeypatch.setattr(toys.Drift, "start", refuses)
    with pytest.raises(ConfigurationError, match="no"):
        run(toy_config(), out=tmp_path / "run")
    assert not (tmp_path / "run").exists()


def test_workers_are_let_go(toy_config: Load, tmp_path: Path) -> None:
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
    monkeypatch.setattr(evoframe.record.store, "_SYNC_INTERVAL", 0.0)  # files of a champion follow at once
    with pytest.raises(SystemExit):
        run(toy_config(), out=tmp_path / "run")
    killed_run = load_run(tmp_path / "run")
    assert killed_run.champion().score == max(pair["score"] for pair in killed_run.pairs())
    assert killed_run.champion().score > read_champion(tmp_path / "run" / "champion.json").score


class TestPython:
    def test_settings_are_keyword_arguments(
        self, toy_file: Path, toy_plugins: Plugins, tmp_path: Path
    ) -> None:
        finished = run(
            toy_file,
            seed=5,
            out=tmp_path / "run",
            plugins=toy_plugins,
            collaboration="toy-first",
            **{"run.generations": 1, "collaboration.n": 3},
        )
        assert finished.config["run"] == {"seed": 5, "generations": 1}
        assert finished.config["collaboration"] == {"name": "toy-first", "n": 3}

    def test_numbers_of_numpy_are_numbers(self, toy_file: Path, toy_plugins: Plugins, tmp_path: Path) -> None:
        finished = run(
            toy_file,
            seed=np.int64(5),  # type: ignore[arg-type]  # as a script may well do
            out=tmp_path / "run",
            plugins=toy_plugins,
            simulator={"limit": np.float64(2.5)},
        )
        assert finished.config["run"]["seed"] == 5
        assert finished.config["simulator"]["limit"] == 2.5

    def test_a_complete_configuration_takes_no_settings(self, toy_config: Load) -> None:
        with pytest.raises(TypeError, match="give settings to load_config"):
            run(toy_config(), seed=4)

    def test_what_is_no_run_is_refused(self, tmp_path: Path) -> None:
        with pytest.raises(InputError, match="is no run's directory"):
            load_run(tmp_path)
        (tmp_path / "config.toml").write_text("[run]")
        with pytest.raises(InputError, match=r"extends: .* is complete; expected false, found nothing"):
            load_run(tmp_path)
        (tmp_path / "config.toml").write_text("extends = false")
        with pytest.raises(InputError, match=r"run\.db: there is no such file"):
            load_run(tmp_path)
        (tmp_path / "run.db").write_text(
            "this is no database, but it is long enough to be taken for one" * 10
        )
        with pytest.raises(InputError, match="file is not a database"):
            load_run(tmp_path)

    def test_another_format_is_refused(self, toy_config: Load, tmp_path: Path) -> None:
        finished = run(toy_config(), out=tmp_path / "run")
        with contextlib.closing(sqlite3.connect(finished.directory / "run.db")) as database, database:
            database.execute("UPDATE meta SET value = '99' WHERE key = 'format'")
        with pytest.raises(InputError, match="has the format '99', but this evoframe reads format 2"):
            load_run(finished.directory)


class TestObservers:
    def test_are_told_of_a_turn_only_when_it_is_saved(
        self, toy_config: Load, toy_plugins: Plugins, tmp_path: Path
    ) -> None:
        told: list[Any] = []

        def started(directory: Path) -> None:
            told.append("started")

        def turned(turn: Turn) -> None:
            told.append((turn.index, len({row[0] for row in rows(tmp_path / "run", "turns")})))

        def finished(completed: bool) -> None:
            told.append(completed)

        observer = plugin(
            evoframe_run_started=started, evoframe_turn_finished=turned, evoframe_run_finished=finished
        )
        toy_plugins.add(observer, Source("watcher", "1.0", "watch"))
        run(toy_config(), out=tmp_path / "run", plugins=toy_plugins)
        assert told == ["started", *[(index, index + 1) for index in range(9)], True]

    @pytest.mark.parametrize("hook", ["run_started", "turn_finished", "run_finished"])
    def test_one_that_raises_changes_nothing(
        self, toy_config: Load, toy_plugins: Plugins, tmp_path: Path, hook: str
    ) -> None:
        undisturbed = run(toy_config(), out=tmp_path / "undisturbed")

        def told() -> None:
            raise OSError("no disk")

        toy_plugins.add(plugin(**{f"evoframe_{hook}": told}), Source("watcher", "1.0", "watch"))
        with pytest.warns(PluginWarning, match="observer 'watcher:watch' is disabled: OSError: no disk"):
            disturbed = run(toy_config(), out=tmp_path / "disturbed", plugins=toy_plugins)
        assert disturbed.pairs() == undisturbed.pairs()


def test_a_run_that_is_stopped_keeps_all_turns_and_says_that_it_is_not_complete(
    toy_config: Load, tmp_path: Path
) -> None:
    asked: list[None] = []

    def stop() -> bool:
        asked.append(None)
        return len(asked) == 4

    execution = prepare(toy_config(), Plugins(), tmp_path / "run")
    assert not execution.play(stop).finished()
    stopped = load_run(tmp_path / "run")
    assert max(row["turn"] for row in stopped.turns()) == 3
    assert stopped.summary() == {}


def test_a_turn_and_its_state_are_saved_both_or_neither(
    toy_config: Load, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    state = toys.DriftRun.state
    calls: list[None] = []

    def unsaveable(self: toys.DriftRun) -> Any:
        calls.append(None)
        return state(self) if len(calls) < 5 else {"not": float("nan")}

    monkeypatch.setattr(toys.DriftRun, "state", unsaveable)
    with pytest.raises(RunError, match=r"'toy-drift' \(plugin .*\): its state .*turn 3"):
        run(toy_config(), out=tmp_path / "run")
    saved = load_run(tmp_path / "run")
    last = max(row["turn"] for row in saved.turns())
    assert max(row["turn"] for row in saved.table("state")) == last
    assert max(row["turn"] for row in saved.pairs()) == last == 2


class TestChampionFile:
    @pytest.fixture
    def champion(self, toy_config: Load, tmp_path: Path) -> Path:
        return run(toy_config(), out=tmp_path / "run").directory / "champion.json"

    def test_is_read_back_exactly(self, champion: Path) -> None:
        found = read_champion(champion)
        design = found.design
        assert found.simulation == {
            "simulator": {"name": "toy-product", "limit": 1e9},
            "objective": {"name": "toy-value"},
        }
        assert design.roles["a"][0] * design.roles["b"][0] == found.score
        again = design_from_json(design_to_json(design))
        assert all((again.roles[role] == array).all() for role, array in design.roles.items())

    @pytest.mark.parametrize(
        ("change", "message"),
        [
            (lambda d: [d], "this JSON is no champion"),
            (lambda d: {}, "this JSON is no champion"),
            (lambda d: {**d, "format": 2}, "format 2, but this evoframe reads format 1"),
            (lambda d: {**d, "score": "high"}, "score: expected a number, found 'high'"),
            (lambda d: {**d, "design": []}, "design: not as evoframe writes it"),
            (
                lambda d: {**d, "design": {"a": {"dtype": "object", "shape": [1], "values": [1]}}},
                "unknown dtype",
            ),
            (
                lambda d: {**d, "design": {"a": {"dtype": "float64", "shape": [2], "values": [1.0]}}},
                "cannot reshape",
            ),
            (
                lambda d: {**d, "design": {"a": {"dtype": "uint8", "shape": [1], "values": [-5]}}},
                "design: not as",
            ),
            (
                lambda d: {**d, "design": {"a": {"dtype": "float64", "shape": [1], "values": ["x"]}}},
                "design: not as",
            ),
        ],
    )
    def test_that_was_changed_is_refused_with_its_name(
        self, champion: Path, change: Callable[[Any], Any], message: str
    ) -> None:
        champion.write_text(json.dumps(change(json.loads(champion.read_text()))))
        with pytest.raises(InputError, match=rf"champion\.json: .*{message}"):
            read_champion(champion)

    @pytest.mark.parametrize("text", ["", "{", "nope", "[" * 100_000])
    def test_that_is_no_json_is_refused(self, champion: Path, text: str) -> None:
        champion.write_text(text)
        with pytest.raises(InputError, match="not valid JSON"):
            read_champion(champion)


@given(
    arrays(
        st.sampled_from(["bool", "int8", "int64", "uint8", "uint64", "float16", "float32", "float64"]),
        array_shapes(max_dims=3, max_side=4),
        elements={"allow_nan": False, "allow_infinity": False},
    )
)
def test_any_design_of_numbers_survives_its_json(array: NDArray[Any]) -> None:
    document = json.loads(json.dumps(design_to_json(Design({"a": array}))))
    again = design_from_json(document).roles["a"]
    assert (again.dtype, again.tobytes()) == (array.dtype, array.tobytes())


def test_a_design_that_is_no_array_of_numbers_is_refused_when_it_is_recorded() -> None:
    with pytest.raises(RunError, match="the design's role 'a' is no array of finite numbers, but float64"):
        design_to_json(Design({"a": np.array([np.nan])}))
    with pytest.raises(RunError, match="but complex128"):
        design_to_json(Design({"a": np.array([1j])}))
