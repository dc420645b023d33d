"""Sources of designs: the designs that they contain, and the settings to simulate them with."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import toys

from evoframe import ConfigurationError, InputError, Run, RunConfig, discover, run
from evoframe.config import read_layers
from evoframe.contract import FileOptions
from evoframe.designs.sources import read_job
from evoframe.registry.registry import Plugins

Load = Callable[..., RunConfig]

WITH_SETTINGS = "designs = [{ a = 2.0, b = 3.0 }, { a = 1.0 }]\n[settings]\ngain = 2.0\nlimit = 100.0\n"
POPULATION = '{encoder={name="toy-number", role="%s"}, evolver="toy-drift"}'
PAPER = [f"populations={{a={POPULATION % 'a'}, b={POPULATION % 'b'}}}"]  # toys in the default preset
WITHOUT = "designs = [{ a = 2.0, b = 3.0 }]\n"


@pytest.fixture(scope="module")
def plugins() -> Plugins:
    """The built-in plugins and the toys."""
    return discover([toys.__file__])


@pytest.fixture
def varied(tmp_path: Path) -> str:
    """A preset whose simulator has all optional methods."""
    path = tmp_path / "varied.toml"
    simulator = 'name = "toy-varied"\ngain = 7.0'
    path.write_text(toys.CONFIGURATION.replace('name = "toy-product"', simulator))
    return str(path)


@pytest.fixture
def toy_path(tmp_path: Path) -> Callable[[str], Path]:
    def write(text: str) -> Path:
        path = tmp_path / "two.toy"
        path.write_text(text)
        return path

    return write


Written = Callable[[str], Path]


def gain_of(config: RunConfig) -> Any:
    return config.tables()["simulator"].get("gain")


class TestFile:
    def test_brings_designs_with_labels(self, plugins: Plugins, varied: str, toy_path: Written) -> None:
        job = read_job(toy_path(WITH_SETTINGS), read_layers(varied), [], plugins)
        assert job.labels == ("two.toy[0]", "two.toy[1]")
        assert [sorted(design.roles) for design in job.designs] == [["a", "b"], ["a"]]
        assert (job.run, job.score) == (None, None)

    def test_brings_settings_that_replace_those_of_the_preset(
        self, plugins: Plugins, varied: str, toy_path: Written
    ) -> None:
        assert gain_of(read_job(toy_path(WITH_SETTINGS), read_layers(varied), [], plugins).config) == 2.0
        assert gain_of(read_job(toy_path(WITHOUT), read_layers(varied), [], plugins).config) == 7.0

    def test_is_overridden_by_settings(self, plugins: Plugins, varied: str, toy_path: Written) -> None:
        job = read_job(toy_path(WITH_SETTINGS), read_layers(varied), ["simulator.gain=5"], plugins)
        assert job.config.tables()["simulator"] == {"name": "toy-varied", "limit": 100.0, "gain": 5.0}

    def test_is_read_by_the_simulator_in_the_settings(
        self, plugins: Plugins, tmp_path: Path, toy_path: Written
    ) -> None:
        path = tmp_path / "plain.toml"
        path.write_text(toys.CONFIGURATION)
        job = read_job(toy_path(WITH_SETTINGS), read_layers(path), ["simulator=toy-varied"], plugins)
        assert gain_of(job.config) == 2.0

    def test_completes_settings_that_are_invalid_without_it(
        self, plugins: Plugins, tmp_path: Path, toy_path: Written
    ) -> None:
        path = tmp_path / "narrow.toml"
        fitting = 'name = "toy-fitting"\nlimit = 1.0'
        path.write_text(toys.CONFIGURATION.replace('name = "toy-product"', fitting))
        job = read_job(toy_path(WITH_SETTINGS), read_layers(path), ["simulator.gain=50"], plugins)
        assert job.config.tables()["simulator"] == {"name": "toy-fitting", "limit": 100.0, "gain": 50.0}

    def test_with_a_fault_in_its_settings_is_named(
        self, plugins: Plugins, varied: str, toy_path: Written
    ) -> None:
        path = toy_path(WITH_SETTINGS.replace("gain = 2.0", "gain = -1.0\nspeed = 3"))
        with pytest.raises(ConfigurationError) as caught:
            read_job(path, read_layers(varied), [], plugins)
        assert re.search(rf"{path}: simulator\.gain: .*-1\.0", str(caught.value))
        assert f"{path}: simulator.speed: " in str(caught.value)

    def test_whose_settings_cannot_deliver_the_record_is_refused(
        self, plugins: Plugins, varied: str, toy_path: Written
    ) -> None:
        path = toy_path(WITH_SETTINGS)
        with pytest.raises(ConfigurationError, match=r"objective: .*1\.0 .*3\.0"):
            read_job(path, read_layers(varied), ['objective={name="toy-late", until=3.0}'], plugins)

    def test_reports_all_faults_of_the_settings(
        self, plugins: Plugins, varied: str, toy_path: Written
    ) -> None:
        with pytest.raises(ConfigurationError, match=r"run\.seed(.|\n)*simulator: .*nothing"):
            read_job(toy_path(WITHOUT), read_layers(varied), ["simulator=nothing", "run.seed=-1"], plugins)

    def test_whose_settings_cannot_deliver_the_record_need_not_be_scored(
        self, plugins: Plugins, varied: str, toy_path: Written
    ) -> None:
        late = Path(varied)
        late.write_text(late.read_text().replace('"toy-value"', '"toy-late"\nuntil = 3.0'))
        path = toy_path(WITHOUT)
        with pytest.raises(ConfigurationError) as caught:
            read_job(path, read_layers(varied), [], plugins)
        assert [fault.key for fault in caught.value.faults] == ["objective"]
        [fault] = caught.value.faults
        assert read_job(path, read_layers(varied), [], plugins, scored=False).unscored == fault.problem
        assert (
            read_job(path, read_layers(varied), ["objective.until=1.0"], plugins, scored=False).unscored == ""
        )
        for asked in (["objective.until=2.0"], ['objective={name="toy-late", until=2.0}']):
            with pytest.raises(ConfigurationError) as caught:
                read_job(path, read_layers(varied), asked, plugins, scored=False)
            assert caught.value.faults[0].source == f"--set {asked[0]}"

    def test_for_a_simulator_that_cannot_read_files_is_refused(
        self, plugins: Plugins, varied: str, toy_path: Written
    ) -> None:
        path = toy_path(WITHOUT)
        with pytest.raises(ConfigurationError, match="'toy-product'") as caught:
            read_job(path, read_layers(varied), ["simulator=toy-product"], plugins)
        assert (caught.value.source, caught.value.key) == (str(path), "simulator")


class TestObjective:
    """The objective of a file with settings: suggested by the simulator, unless the user chose one."""

    SUGGESTING = "simulator=toy-suggesting"

    def test_of_a_file_with_settings_is_the_suggested_one(self, plugins: Plugins, toy_path: Written) -> None:
        job = read_job(toy_path(WITH_SETTINGS), None, [*PAPER, self.SUGGESTING], plugins)
        assert job.config.simulation()["objective"] == {"name": "toy-late", "until": 0.5}

    def test_of_a_file_without_settings_is_that_of_the_preset(
        self, plugins: Plugins, toy_path: Written
    ) -> None:
        overrides = [*PAPER, self.SUGGESTING]
        job = read_job(toy_path(WITHOUT), None, overrides, plugins, scored=False)
        assert job.config.objective.name == "tip-dz"
        assert "'tip'" in job.unscored

    def test_is_the_one_that_is_set(self, plugins: Plugins, toy_path: Written) -> None:
        overrides = [*PAPER, self.SUGGESTING, "objective=toy-value"]
        job = read_job(toy_path(WITH_SETTINGS), None, overrides, plugins)
        assert job.config.simulation()["objective"] == {"name": "toy-value"}

    def test_keeps_the_options_that_are_set(self, plugins: Plugins, toy_path: Written) -> None:
        overrides = [*PAPER, self.SUGGESTING, "objective.until=0.25"]
        job = read_job(toy_path(WITH_SETTINGS), None, overrides, plugins)
        assert job.config.simulation()["objective"] == {"name": "toy-late", "until": 0.25}

    def test_is_that_of_a_given_preset(self, plugins: Plugins, varied: str, toy_path: Written) -> None:
        job = read_job(toy_path(WITH_SETTINGS), read_layers(varied), [self.SUGGESTING], plugins)
        assert job.config.objective.name == "toy-value"

    def test_that_does_not_exist_is_a_fault_of_the_file(
        self, plugins: Plugins, toy_path: Written, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        simulator = plugins.find("simulator", "toy-suggesting").component
        monkeypatch.setattr(simulator, "objective_for", lambda *_: {"name": "nothing"})
        path = toy_path(WITH_SETTINGS)
        with pytest.raises(ConfigurationError, match="nothing") as caught:
            read_job(path, None, [*PAPER, self.SUGGESTING], plugins)
        assert [(fault.source, fault.key) for fault in caught.value.faults] == [(str(path), "objective")]


class TestRun:
    @pytest.fixture
    def finished(self, plugins: Plugins, varied: str, tmp_path: Path) -> Run:
        return run(varied, out=tmp_path / "run", plugins=plugins)

    def test_stands_for_its_champion_as_it_was_simulated(self, plugins: Plugins, finished: Run) -> None:
        job = read_job(finished.directory, None, [], plugins)
        assert job.run == finished
        assert job.score == finished.champion().score
        assert job.labels == (str(finished.directory),)
        assert job.config.simulation() == finished.champion().simulation
        assert job.config.executor.name == "toy-here"

    @pytest.mark.parametrize(
        ("overrides", "same"),
        [
            (["executor=serial", "run.seed=4"], True),
            (["simulator.gain=7"], True),
            (["simulator.gain=8"], False),
            (["objective=toy-late"], False),
        ],
    )
    def test_has_its_score_only_with_unchanged_simulator_and_objective(
        self, plugins: Plugins, finished: Run, overrides: list[str], same: bool
    ) -> None:
        expected = finished.champion().score if same else None
        for path in (finished.directory, finished.directory / "champion.json"):
            assert read_job(path, None, overrides, plugins).score == expected

    @pytest.mark.parametrize(
        ("options", "name"),
        [(FileOptions(dialect="fork"), "--dialect"), (FileOptions(base=Path("base.vxa")), "--base")],
    )
    def test_has_no_dialect_and_no_base(
        self, plugins: Plugins, finished: Run, options: FileOptions, name: str
    ) -> None:
        for path in (finished.directory, finished.directory / "champion.json"):
            with pytest.raises(ConfigurationError, match="read in one way only") as caught:
                read_job(path, None, [], plugins, options=options)
            assert caught.value.source == name

    def test_is_simulated_with_a_given_preset(
        self, plugins: Plugins, finished: Run, varied: str, toy_file: Path
    ) -> None:
        for path in (finished.directory, finished.directory / "champion.json"):
            job = read_job(path, read_layers(toy_file), [], plugins)
            assert job.config.simulator.name == "toy-product"
            assert job.score is None

    @pytest.mark.parametrize("name", ["nowhere", "nowhere.json", "no\0where", "n" * 5000])
    def test_that_does_not_exist_is_refused(self, plugins: Plugins, tmp_path: Path, name: str) -> None:
        with pytest.raises(InputError, match=r"(where|nnn).*: "):
            read_job(tmp_path / name, None, [], plugins)

    def test_in_a_directory_without_a_run_is_refused(self, plugins: Plugins, tmp_path: Path) -> None:
        with pytest.raises(InputError, match=r"config\.toml") as caught:
            read_job(tmp_path, None, [], plugins)
        assert caught.value.source == str(tmp_path)

    def test_whose_champion_lacks_a_role_is_refused(self, plugins: Plugins, finished: Run) -> None:
        path = finished.directory / "champion.json"
        document = json.loads(path.read_text())
        document["simulation"] = {"simulator": {"name": "toy-demanding"}, "objective": {"name": "toy-value"}}
        path.write_text(json.dumps(document))
        with pytest.raises(InputError, match="morphology") as caught:
            read_job(path, None, [], plugins)
        assert (caught.value.source, caught.value.key) == (str(path), "design")
