"""Tests of configurations: presets, files, overrides, and the report of all faults in one error."""

from __future__ import annotations

import functools
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import attrs
import pytest
import tomli_w
from hypothesis import given, strategies as st
from modules import plugin
from toy_capabilities import VARIANTS

import evoframe
from evoframe import ConfigurationError, RunConfig, StructureError
from evoframe.config.layers import layers_in, preset_names
from evoframe.config.resolve import load_config, resolve_component, resolve_layers
from evoframe.contract.config import Source
from evoframe.registry.discovery import discover
from evoframe.registry.registry import Plugins
from evoframe_evolvers import Neat
from evoframe_strategies import Sum, Worst

Load = Callable[..., RunConfig]

HERE = Source("here", "1.0", "main")


@functools.cache
def discovered() -> Plugins:
    return discover()


@pytest.fixture
def installed() -> Plugins:
    return discovered()


class TestPresets:
    @pytest.mark.parametrize("preset", preset_names())
    def test_every_preset_is_valid_and_survives_a_round_trip(
        self, preset: str, installed: Plugins, tmp_path: Path
    ) -> None:
        config = load_config(preset, plugins=installed)
        path = tmp_path / "again.toml"
        path.write_text(config.to_toml())
        assert load_config(path, plugins=installed) == config

    def test_the_documented_presets_exist(self) -> None:
        assert {"paper", "authors-rates", "quick"} <= set(preset_names())

    def test_paper_states_every_option_of_its_components(self, installed: Plugins) -> None:
        """The preset lists every parameter of the experiment in one file."""
        text = Path(evoframe.__file__).parent.joinpath("config", "presets", "paper.toml").read_text()
        stated = tomllib.loads(text)
        tables = load_config("paper", plugins=installed).tables()
        for key in ("run", "collaboration", "simulator", "objective", "executor"):
            assert stated[key] == tables[key]

    def test_paper_has_the_numbers_of_the_published_table(self, installed: Plugins) -> None:
        config = load_config("paper", plugins=installed)
        for population in config.populations.values():
            neat = population.evolver.component
            assert isinstance(neat, Neat)
            assert population.size == 25
            assert (neat.compatibility_threshold, neat.max_stagnation, neat.survival_threshold) == (
                3.0,
                25,
                0.6,
            )
            assert (neat.compatibility_disjoint, neat.compatibility_weight) == (1.0, 0.5)
            assert (neat.connection_add, neat.connection_delete, neat.enabled_mutate_rate) == (0.3, 0.2, 0.5)
            assert (neat.node_add, neat.node_delete, neat.activation_mutate_rate) == (0.3, 0.2, 0.4)
            assert len(neat.activations) == 23

    def test_authors_rates_are_those_of_the_authors_files(self, installed: Plugins) -> None:
        config = load_config("authors-rates", plugins=installed)
        morphology, controller = (p.evolver.component for p in config.populations.values())
        assert isinstance(morphology, Neat)
        assert isinstance(controller, Neat)
        assert (morphology.connection_delete, morphology.node_delete, morphology.node_add) == (
            0.15,
            0.15,
            0.3,
        )
        assert (controller.connection_add, controller.node_add, controller.node_delete) == (0.2, 0.2, 0.1)
        for neat in (morphology, controller):
            assert (neat.survival_threshold, neat.max_stagnation) == (0.4, 20)


FAULTS: list[tuple[str, str, list[str]]] = [
    ("aggregator=toy-mena", "aggregator", ["'toy-mena'", "'toy-mean'", "installed: toy-mean"]),
    ("collaboration.n=30", "collaboration", ["30", "6 members"]),
    ("collaboration.n=0", "collaboration.n", [">= 1", "found 0"]),
    ("collaboration.n=two", "collaboration.n", ["whole number", 'found "two"']),
    ("collaboration.n=2.5", "collaboration.n", ["whole number", "found 2.5"]),
    ("collaboration.n=true", "collaboration.n", ["whole number", "found true"]),
    ("collaboration.m=2", "collaboration.m", ["unknown option", "options: n"]),
    ("simulator.limitt=2", "simulator.limitt", ["unknown option", "'limit'", "options: limit"]),
    ("simulator.limit=inf", "simulator.limit", ["finite number", "found inf"]),
    ("simulator.limit=[1]", "simulator.limit", ["a number", "found [1]"]),
    ("aggregator=5", "aggregator", ["toy-mean", "'name'", "found 5"]),
    ("run.seed=-1", "run.seed", [">= 0", "found -1"]),
    ("run.sede=1", "run.sede", ["unknown option", "'seed'", "options: seed, generations, timing"]),
    ("run=4", "run", ["a table", "found 4"]),
    ("agregator=5", "agregator", ["unknown key", "'aggregator'"]),
    ("populations.a.size=1", "populations.a.size", [">= 2", "found 1"]),
    ("populations.a.size=101", "populations.a", ["toy-drift", "100", "101"]),
    ("populations.a.evolver=neat", "populations.a.evolver", ["'neat'", "installed: toy-drift"]),
    ("populations.b.encoder.role=a", "populations.b.encoder", ["provides", "'a'"]),
    ("populations.b.encoder.needs=a", "populations.b.encoder.needs", ["a list", 'found "a"']),
    ("populations.b.encoder.needs=[1]", "populations.b.encoder.needs[0]", ["a string", "found 1"]),
    ("populations.turn=4", "populations.turn", ["'turn'", "database"]),
    ("populations.turn=4", "populations.turn", ["a table", "found 4"]),
    ("populations.A=4", "populations.A", ["'A'", "lower-case"]),
    ("extends=quick", "extends", ["file"]),
    ('plugins.require=["nobody"]', "plugins.require", ["'nobody'", "installed: toy-box"]),
    ("plugins.block=toy", "plugins.block", ["a list", 'found "toy"']),
]


def faults_of(load: Callable[[], object]) -> tuple[ConfigurationError, ...]:
    """Return the faults with which loading a configuration fails."""
    with pytest.raises(ConfigurationError) as caught:
        load()
    return caught.value.faults


class TestFaults:
    @pytest.mark.parametrize(("override", "key", "parts"), FAULTS)
    def test_each_has_its_origin_its_key_and_the_value(
        self, toy_config: Load, override: str, key: str, parts: list[str]
    ) -> None:
        faults = faults_of(lambda: toy_config(override))
        assert {fault.source for fault in faults} == {f"--set {override}"}
        problems = [fault.problem for fault in faults if fault.key == key]
        assert any(all(part in problem for part in parts) for problem in problems), problems

    def test_a_missing_role_is_a_fault_of_the_encoder_that_requires_it(
        self, toy_config: Load, toy_file: Path
    ) -> None:
        [fault] = faults_of(lambda: toy_config("populations.a.encoder.role=z"))
        assert (fault.source, fault.key) == (str(toy_file), "populations.b.encoder")
        assert "requires the role 'a'" in fault.problem

    def test_a_role_that_the_simulator_requires_must_be_provided(self, toy_config: Load) -> None:
        [fault] = faults_of(lambda: toy_config("simulator=toy-demanding"))
        assert (fault.source, fault.key) == ("--set simulator=toy-demanding", "simulator")
        assert "'morphology'" in fault.problem

    def test_all_are_reported_at_once(self, toy_config: Load) -> None:
        bad = ["aggregator=wn", "collaboration.n=30", "run.seed=x", "simulator.limt=1", "simulator.limit=a"]
        with pytest.raises(ConfigurationError) as caught:
            toy_config(*bad)
        assert {fault.source for fault in caught.value.faults} == {f"--set {each}" for each in bad}
        lines = str(caught.value).splitlines()
        assert lines[0].startswith("5 ")
        assert [line.strip() for line in lines[1:]] == [str(fault) for fault in caught.value.faults]

    def test_a_fault_in_a_file_names_the_file(self, toy_config: Load, toy_file: Path) -> None:
        toy_file.write_text(toy_file.read_text().replace("n = 2", "n = 30"))
        [fault] = faults_of(toy_config)
        assert (fault.source, fault.key) == (str(toy_file), "collaboration")
        assert all(part in fault.problem for part in ("30", "6 members", "population 'a'"))

    def test_a_population_of_the_base_can_be_left_out(self, toy_config: Load) -> None:
        config = toy_config("populations.b=false", "simulator={name='toy-product'}")
        assert list(config.populations) == ["a"]
        assert "b" not in config.tables()["populations"]

    def test_a_run_needs_a_population(self, toy_config: Load, toy_file: Path) -> None:
        text = toy_file.read_text()
        start, end = text.index("[populations.a]"), text.index("[collaboration]")
        toy_file.write_text(text[:start] + text[end:])
        fault = faults_of(toy_config)[0]
        assert (fault.source, fault.key) == (str(toy_file), "populations")
        assert "found none" in fault.problem


class TestRealComponents:
    @pytest.mark.parametrize(
        ("override", "key", "parts"),
        [
            ("aggregator=wn", "aggregator", ["'wn'", "'wm'", "am, difference, gm"]),
            ("collaboration.n=4", "aggregator", ["4 collaborators", "2, 3, 5, 7, 10"]),
            ("collaboration.n=30", "collaboration", ["30", "25"]),
            ("simulator.step=1", "simulator.step", ["unknown option"]),
            ('aggregator.weights=[0.5, "a"]', "aggregator.weights[1]", ["a number", 'found "a"']),
            ("simulator.duration=0", "simulator.duration", ["1e9 s", "found 0.0"]),
            ("simulator.duration=0.03", "objective", ["sample 5", "simulator.duration = 0.03 s"]),
            ("simulator.voxel_size=1e9", "simulator.voxel_size", ["1e-6", "1e6 m", "found 1000000000.0"]),
            ("simulator.duration=1e300", "simulator.duration", ["1e9 s", "found 1e+300"]),
            ("simulator.phase_unit=degrees", "simulator.phase_unit", ['"cycles", "radians"', '"degrees"']),
            ("objective.last=0", "objective.last", [">= 1", "found 0"]),
            ("objective.first=7", "objective", ["first", "last"]),
            (
                "populations.morphology.evolver.bias.init_mean=x",
                "populations.morphology.evolver.bias.init_mean",
                ['"x"'],
            ),
            (
                "populations.morphology.encoder.canvas=[20, 8]",
                "populations.morphology.encoder.canvas",
                ["list of 3", "found [20, 8]"],
            ),
        ],
    )
    def test_name_the_values_that_they_refuse(
        self, installed: Plugins, override: str, key: str, parts: list[str]
    ) -> None:
        faults = faults_of(lambda: load_config("paper", overrides=[override], plugins=installed))
        [fault] = [each for each in faults if each.key == key]
        assert fault.source == f"--set {override}"
        assert all(part in fault.problem for part in parts), fault.problem


names = st.sampled_from(["am", "wm", "gm", "hm"])


@given(
    aggregator=names,
    n=st.sampled_from([2, 3, 5, 7, 10]),
    seed=st.integers(0, 2**63 - 1),
    duration=st.floats(0.07, 0.2),
    collision=st.booleans(),
)
def test_any_configuration_survives_a_round_trip(
    aggregator: str,
    n: int,
    seed: int,
    duration: float,
    collision: bool,
    tmp_path_factory: pytest.TempPathFactory,
) -> None:
    plugins = discovered()
    overrides = [
        f"aggregator={aggregator}",
        f"collaboration.n={n}",
        f"run.seed={seed}",
        f"simulator.duration={duration!r}",
        f"simulator.self_collision={str(collision).lower()}",
    ]
    config = load_config("paper", overrides=overrides, plugins=plugins)
    path = tmp_path_factory.getbasetemp() / "round-trip.toml"
    path.write_text(config.to_toml())
    again = load_config(path, plugins=plugins)
    assert again == config
    assert tomli_w.dumps(again.tables()) == config.to_toml()


@pytest.mark.parametrize("name", VARIANTS)
def test_own_components_roles_and_nested_components_survive_a_round_trip(
    toy_variant: Load, toy_plugins: Plugins, tmp_path: Path, name: str
) -> None:
    config = toy_variant(name)
    path = tmp_path / "again.toml"
    path.write_text(config.to_toml())
    again = load_config(path, plugins=toy_plugins)
    assert again == config
    assert again.to_toml() == config.to_toml()
    path.write_text(tomli_w.dumps(config.recorded()))
    assert load_config(path, plugins=toy_plugins) == config


@attrs.define
class Changeable:
    domain = (-1e100, 1e100)

    def check(self, n: int) -> None:
        pass

    def aggregate(self, scores: Any) -> float:
        return 0.0


@attrs.frozen
class Unfinished:
    domain = (-1e100, 1e100)

    def aggregate(self, scores: Any) -> float:
        return 0.0


class TestComponentsOfOthers:
    @pytest.mark.parametrize(("component", "problem"), [(Changeable, "frozen"), (Unfinished, "check")])
    def test_are_held_to_their_protocol_when_they_are_chosen(
        self, toy_plugins: Plugins, toy_config: Callable[..., RunConfig], component: type[Any], problem: str
    ) -> None:
        toy_plugins.add(plugin(evoframe_aggregators=lambda: {"mine": component}), HERE)
        toy_config()  # a component that is not chosen is not checked
        [fault] = faults_of(lambda: toy_config("aggregator=mine"))
        assert (fault.source, fault.key) == ("--set aggregator=mine", "aggregator")
        assert all(part in fault.problem for part in ("'mine'", "'main' of here 1.0", problem))
        assert ("frozen" in fault.problem) == (component is Changeable)


def test_a_run_of_a_local_plugin_names_the_option_that_loads_it(installed: Plugins) -> None:
    components = {"aggregator": "'mine' of mine local", "simulator": "'simulators' of evoframe 0.1.0"}
    tables = {**load_config("quick").tables(), "provenance": {"components": components}}
    tables["aggregator"] = {"name": "mine"}
    with pytest.raises(ConfigurationError) as caught:
        resolve_layers(layers_in(tables, "config.toml"), "quick", installed)
    [hint] = caught.value.__notes__
    assert "-p PATH/mine.py" in hint


class TestComponentsOnTheirOwn:
    """``resolve_component``, with which contracts read the options of a component."""

    def test_components_among_the_options_are_chosen(self) -> None:
        table = {"parts": ["random", {"name": "sum", "parts": [{"name": "worst", "n": 3}]}]}
        combined = resolve_component(table, Sum, ("component",))
        assert [part.name for part in combined.parts] == ["random", "sum"]
        [inner] = combined.parts[1].component.parts  # type: ignore[attr-defined]
        assert inner.component == Worst(n=3)
        assert inner.source.entry_point == "strategies"

    def test_all_faults_are_reported_with_their_paths(self) -> None:
        table = {"parts": [{"name": "random", "n": 0}, "nobody"]}
        with pytest.raises(StructureError) as refused:
            resolve_component(table, Sum, ("component",))
        paths = [".".join(fault.path) for fault in refused.value.faults]
        assert paths == ["component.parts[0].n", "component.parts[1]"]

    def test_plugins_are_loaded_only_for_them(self, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr("evoframe.config.resolve.discover", lambda: pytest.fail("loaded plugins"))
        assert resolve_component({"n": 4}, Worst, ("component",)) == Worst(n=4)
