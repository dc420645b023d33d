"""Verification and exported champion of a run, if its simulator supports them."""

from __future__ import annotations

import json
import logging
import re
import shutil
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest
import toys
from modules import plugin
from recorded import assert_same_result, written

import evoframe_executors
from evoframe import (
    ConfigurationError,
    Design,
    Export,
    InputError,
    Outcome,
    Run,
    RunConfig,
    RunError,
    Verification,
    load_run,
    run,
    verify,
)
from evoframe.contract.config import Source
from evoframe.record import store
from evoframe.registry.registry import Plugins
from evoframe.runs.starting import prepare

Load = Callable[..., RunConfig]


@pytest.fixture
def finished(toy_config: Load, tmp_path: Path) -> Run:
    return run(toy_config("simulator=toy-varied"), out=tmp_path / "run")


def toy_design(directory: Path) -> dict[str, float]:
    [(_, design)] = toys.Varied().read(directory / "champion.toy")
    return {role: array[0] for role, array in design.roles.items()}


class TestExportedChampion:
    def test_is_written_in_every_format(self, finished: Run) -> None:
        names = sorted(path.name for path in finished.directory.iterdir())
        assert names == [
            "champion.json", "champion.toy", "champion.txt", "config.toml",
            "run.db", "run.lock", "verification.json",
        ]  # fmt: skip
        roles = finished.champion().design.roles
        assert toy_design(finished.directory) == {role: array[0] for role, array in roles.items()}

    def test_is_up_to_date_after_every_turn(
        self, toy_config: Load, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setattr(store, "_SYNC_INTERVAL", 0.0)  # by default within a second
        scores: list[float] = []

        def stop() -> bool:
            exported = toy_design(tmp_path / "run")
            scores.append(exported["a"] * exported["b"])
            assert scores[-1] == load_run(tmp_path / "run").champion().score
            return False

        config = toy_config("simulator=toy-varied")
        prepare(config, Plugins(), tmp_path / "run").play(stop)
        assert len(set(scores)) > 2

    def test_is_the_same_for_the_same_run(self, finished: Run, toy_config: Load, tmp_path: Path) -> None:
        again = run(toy_config("simulator=toy-varied"), out=tmp_path / "elsewhere")
        assert_same_result(finished.directory, again.directory)
        assert set(written(again.directory)) == {
            "champion.json", "champion.toy", "champion.txt", "verification.json",
        }  # fmt: skip

    def test_that_a_format_cannot_represent_has_no_file_and_does_not_stop_the_run(
        self,
        toy_config: Load,
        tmp_path: Path,
        monkeypatch: pytest.MonkeyPatch,
        caplog: pytest.LogCaptureFixture,
    ) -> None:
        export = toys.Varied.export
        calls: list[str] = []

        def only_the_first(self: toys.Varied, design: Design, format_: str) -> Export:
            calls.append(format_)
            if format_ == "txt" and calls.count("txt") > 1:
                raise InputError("this design has no words")
            return export(self, design, format_)

        monkeypatch.setattr(toys.Varied, "export", only_the_first)
        monkeypatch.setattr(store, "_SYNC_INTERVAL", 0.0)  # write every champion, not only the last
        finished = run(toy_config("simulator=toy-varied"), out=tmp_path / "run")
        assert not (finished.directory / "champion.txt").exists()  # not even of an earlier champion
        assert (finished.directory / "champion.toy").exists()
        assert re.search("txt.*: this design has no words", caplog.text)

    def test_that_fails_does_not_stop_the_run(
        self,
        toy_config: Load,
        tmp_path: Path,
        monkeypatch: pytest.MonkeyPatch,
        caplog: pytest.LogCaptureFixture,
    ) -> None:
        def failing(*_: object) -> Export:
            raise ZeroDivisionError("oops")

        monkeypatch.setattr(toys.Varied, "export", failing)
        finished = run(toy_config("simulator=toy-varied"), out=tmp_path / "run")
        assert finished.finished()
        assert re.search("toy.*: ZeroDivisionError: oops", caplog.text)

    def test_logs_omitted_settings(
        self, toy_config: Load, tmp_path: Path, caplog: pytest.LogCaptureFixture
    ) -> None:
        caplog.set_level(logging.INFO)
        run(toy_config("simulator={name='toy-varied', gain=2.0}"), out=tmp_path / "run")
        assert re.search("txt .*: gain", caplog.text)


class TestVerification:
    def test_is_done_at_the_end_of_a_run_and_read_back(self, finished: Run) -> None:
        verification = finished.verification()
        assert isinstance(verification, Verification)
        assert verification.score == finished.champion().score == verification.unchanged.value
        assert [finding.name for finding in verification.findings] == [
            "gain off", "no room", "one number jittered by 10 %",
        ]  # fmt: skip

    def test_is_not_part_of_the_recorded_workload(self, finished: Run, toy_config: Load) -> None:
        plain = run(toy_config(), out=finished.directory.with_name("plain"))
        assert [(row["pairs"], row["simulations"]) for row in finished.workload()] == [
            (row["pairs"], row["simulations"]) for row in plain.workload()
        ]
        assert finished.pairs() == plain.pairs()

    def test_shuts_down_its_workers(self, toy_config: Load, tmp_path: Path) -> None:
        before = len(toys.CLOSED)
        run(toy_config("simulator=toy-varied"), out=tmp_path / "run")
        assert len(toys.CLOSED) == before + 2

    def test_does_not_depend_on_the_workers(
        self, finished: Run, toy_config: Load, toy_plugins: Plugins
    ) -> None:
        before = written(finished.directory)
        toy_plugins.add(evoframe_executors, Source("evoframe", "1", "executors"))
        [again] = verify(finished, plugins=toy_plugins, executor="threads", workers=3)
        assert again == finished.verification()
        assert written(finished.directory) == before

    def test_is_not_done_without_variants(self, toy_config: Load, tmp_path: Path) -> None:
        plain = run(toy_config(), out=tmp_path / "run")
        assert plain.verification() is None

    def test_is_not_done_for_a_stopped_run(self, toy_config: Load, tmp_path: Path) -> None:
        config = toy_config("simulator=toy-varied")
        prepare(config, Plugins(), tmp_path / "run").play(lambda: True)
        assert load_run(tmp_path / "run").verification() is None

    @pytest.mark.parametrize(
        ("damage", "key", "data"),
        [
            (lambda text: text[:-20], "", "JSON"),
            (lambda text: "{}", "", "verification"),
            (lambda text: "[" * 100_000, "", "nested"),
            (lambda text: text.replace('"format":1', '"format":9'), "format", "9"),
            (lambda text: text.replace('"share":1.0', '"share":0.5'), "", "figures"),
        ],
    )
    def test_that_is_damaged_is_refused_with_its_name_and_a_remedy(
        self, finished: Run, damage: Callable[[str], str], key: str, data: str
    ) -> None:
        path = finished.directory / "verification.json"
        path.write_text(damage(path.read_text()))
        with pytest.raises(InputError, match=f": evoframe verify {finished.directory}$") as caught:
            _ = finished.verification()
        assert (caught.value.source, caught.value.key) == (str(path), key)
        assert data in caught.value.problem

    def test_of_a_different_champion_is_refused(
        self, finished: Run, toy_config: Load, tmp_path: Path
    ) -> None:
        other = run(toy_config("simulator=toy-varied", "run.seed=9"), out=tmp_path / "other")
        shutil.copy(other.directory / "verification.json", finished.directory)
        with pytest.raises(InputError, match=f": evoframe verify {finished.directory}$") as caught:
            _ = finished.verification()
        assert caught.value.key == "score"
        assert repr(finished.champion().score) in caught.value.problem
        assert repr(other.champion().score) in caught.value.problem

    def test_that_cannot_be_read_is_an_error(self, finished: Run) -> None:
        path = finished.directory / "verification.json"
        path.unlink()
        path.mkdir()
        with pytest.raises(InputError, match=r"verification\.json: .*Is a directory"):
            _ = finished.verification()


class TestFailingVerification:
    @pytest.mark.parametrize(
        ("error", "words"),
        [(InputError("no variant fits"), "no variant fits"), (KeyError("pivot"), "KeyError: 'pivot'")],
    )
    def test_keeps_the_whole_run(
        self, toy_config: Load, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, error: Exception, words: str
    ) -> None:
        def fails(*_: Any) -> Any:
            raise error

        monkeypatch.setattr(toys.Varied, "variants", fails)
        with pytest.raises(RunError, match=f": {words}$") as caught:
            run(toy_config("simulator=toy-varied"), out=tmp_path / "run")
        assert caught.value.source == str(tmp_path / "run")
        finished = load_run(tmp_path / "run")
        assert finished.summary()["turns"] == 8
        assert finished.champion().score == finished.summary()["best_pair_score"]
        assert finished.verification() is None

    def test_comes_after_everything_else(
        self, toy_config: Load, toy_plugins: Plugins, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        calls: list[Any] = []

        def ended(completed: bool) -> None:
            calls.append((completed, load_run(tmp_path / "run").summary()["turns"]))

        toy_plugins.add(plugin(evoframe_run_finished=ended), Source("watcher", "1.0", "watch"))

        def fails(*_: Any) -> Any:
            calls.append("verifying")
            raise ZeroDivisionError

        monkeypatch.setattr(toys.Varied, "variants", fails)
        with pytest.raises(RunError, match="ZeroDivisionError"):
            run(toy_config("simulator=toy-varied"), out=tmp_path / "run", plugins=toy_plugins)
        assert calls == [(True, 8), "verifying"]


class TestPython:
    def test_a_run_is_verified_again(self, finished: Run, toy_plugins: Plugins) -> None:
        path = finished.directory / "verification.json"
        before = path.read_bytes()
        path.unlink()
        for source in (finished, finished.directory, str(finished.directory)):
            [verification] = verify(source, plugins=toy_plugins)
            assert verification == finished.verification()
            assert path.read_bytes() == before

    def test_with_other_settings_no_file_is_written(self, finished: Run, toy_plugins: Plugins) -> None:
        before = written(finished.directory)
        [verification] = verify(finished, plugins=toy_plugins, simulator={"gain": 3})
        assert verification.unchanged.value == pytest.approx(3 * finished.champion().score)
        assert verification.score is None
        assert written(finished.directory) == before

    def test_every_design_of_a_file_is_verified(
        self, toy_plugins: Plugins, tmp_path: Path, toy_file: Path
    ) -> None:
        path = tmp_path / "two.toy"
        path.write_text("designs = [{ a = 2.0, b = 3.0 }, { a = 1.0 }]\nsettings = { gain = 2.0 }\n")
        verifications = verify(path, preset=str(toy_file), plugins=toy_plugins, simulator="toy-varied")
        assert [one.unchanged.value for one in verifications] == [12.0, 2.0]
        assert [one.score for one in verifications] == [None, None]

    def test_a_simulator_without_variants_is_refused(
        self, toy_config: Load, toy_plugins: Plugins, tmp_path: Path
    ) -> None:
        plain = run(toy_config(), out=tmp_path / "run")
        with pytest.raises(ConfigurationError, match="'toy-product'") as caught:
            verify(plain, plugins=toy_plugins)
        assert (caught.value.source, caught.value.key) == (str(plain.directory), "simulator")

    def test_an_error_of_the_simulator_names_the_file(
        self, finished: Run, toy_plugins: Plugins, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        def refuses(*_: Any) -> list[Outcome]:
            raise InputError("no such body")

        monkeypatch.setattr(toys.Varied, "simulate", refuses)
        with pytest.raises(InputError, match="no such body") as caught:
            verify(finished, plugins=toy_plugins)
        assert caught.value.source == str(finished.directory)


def test_the_file_has_the_documented_keys(finished: Run) -> None:
    document = json.loads((finished.directory / "verification.json").read_text())
    assert isinstance(document, Mapping)
    assert set(document) == {"format", "score", "unit", "variants"}
    assert all(
        set(row) == {"name", "median", "least", "greatest", "share", "draws"} for row in document["variants"]
    )
