"""Configurations: presets, files, overrides, and every fault in one message."""

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

import evoframe
from evoframe import ConfigurationError, RunConfig
from evoframe.config.layers import preset_names
from evoframe.config.resolve import load_config
from evoframe.contract.config import Source
from evoframe.registry.discovery import discover
from evoframe.registry.registry import Plugins
from evoframe_evolvers import Neat

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

    def test_there_are_those_that_the_documentation_names(self) -> None:
        assert {"paper", "authors-rates", "quick"} <= set(preset_names())

    def test_paper_states_every_option_of_its_components(self, installed: Plugins) -> None:
        """So that a reader finds every parameter of the experiment in one file."""
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

    def test_authors_rates_differ_where_the_authors_files_do(self, installed: Plugins) -> None:
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


FAULTS = [
    ("aggregator=toy-mena", "unknown aggregator 'toy-mena'; did you mean 'toy-mean'? installed: toy-mean"),
    ("collaboration.n=30", "collaboration: 30 collaborators of 6 members"),
    ("collaboration.n=0", "collaboration.n: must be >= 1, found 0"),
    ("collaboration.n=two", 'collaboration.n: expected a whole number, found "two"'),
    ("collaboration.n=2.5", "collaboration.n: expected a whole number, found 2.5"),
    ("collaboration.n=true", "collaboration.n: expected a whole number, found true"),
    ("collaboration.m=2", "collaboration.m: unknown option; options: n"),
    ("simulator.limitt=2", "simulator.limitt: unknown option; did you mean 'limit'? options: limit"),
    ("simulator.limit=inf", "simulator.limit: expected a finite number, found inf"),
    ("simulator.limit=[1]", "simulator.limit: expected a number, found [1]"),
    ("aggregator=5", "aggregator: expected the name of one of toy-mean, or a table with name; found 5"),
    ("run.seed=-1", "run.seed: must be >= 0, found -1"),
    ("run.sede=1", "run.sede: unknown option; did you mean 'seed'? options: seed, generations"),
    ("run=4", "run: expected a table, found 4"),
    ("agregator=toy-mean", "agregator: unknown key; did you mean 'aggregator'?"),
    ("populations.a.size=1", "populations.a.size: must be >= 2, found 1"),
    ("populations.a.size=101", "populations.a: toy-drift takes at most 100 members, not 101"),
    ("populations.a.evolver=neat", "populations.a.evolver: unknown evolver 'neat'; installed: toy-drift"),
    ("populations.a.encoder.role=z", "populations.b.encoder: needs the role 'a' from a population before it"),
    ("populations.b.encoder.role=a", "populations.b.encoder: provides the role 'a', which another"),
    ("populations.b.encoder.needs=a", 'populations.b.encoder.needs: expected a list, found "a"'),
    ("populations.b.encoder.needs=[1]", "populations.b.encoder.needs[0]: expected a string, found 1"),
    ("populations.turn=4", "populations.turn: 'turn' is a column of the database; choose another name"),
    ("populations.A=4", "populations.A: 'A': use lower-case letters, digits, - and _"),
    ("extends=quick", "extends: can only be set in a file"),
    (
        'plugins.require=["nobody"]',
        "plugins.require: required plugin 'nobody' is not installed; found: toy-box",
    ),
    ("plugins.block=toy", 'plugins.block: expected a list, found "toy"'),
]


class TestFaults:
    @pytest.mark.parametrize(("override", "message"), FAULTS)
    def test_each_names_its_origin_its_key_and_what_was_found(
        self, toy_config: Load, override: str, message: str
    ) -> None:
        with pytest.raises(ConfigurationError) as caught:
            toy_config(override)
        assert message in str(caught.value)
        if "needs the role" not in message:
            assert f"--set {override}: " in str(caught.value)

    def test_all_are_reported_at_once(self, toy_config: Load) -> None:
        bad = ["aggregator=wn", "collaboration.n=30", "run.seed=x", "simulator.limt=1", "simulator.limit=a"]
        with pytest.raises(ConfigurationError) as caught:
            toy_config(*bad)
        lines = str(caught.value).splitlines()
        assert lines[0] == "5 faults in the configuration:"
        assert len(lines) == 6

    def test_a_fault_in_a_file_names_the_file(self, toy_config: Load, toy_file: Path) -> None:
        toy_file.write_text(toy_file.read_text().replace("n = 2", "n = 30"))
        with pytest.raises(ConfigurationError) as caught:
            toy_config()
        assert (
            str(caught.value) == f"{toy_file}: collaboration: 30 collaborators of 6 members (population 'a')"
        )

    def test_one_population_is_not_enough(self, toy_config: Load, toy_file: Path) -> None:
        text = toy_file.read_text()
        start, end = text.index("[populations.b]"), text.index("[collaboration]")
        toy_file.write_text(text[:start] + text[end:])
        with pytest.raises(ConfigurationError, match="expected at least two tables"):
            toy_config()


class TestRealComponents:
    @pytest.mark.parametrize(
        ("override", "parts"),
        [
            ("aggregator=wn", ["unknown aggregator 'wn'; did you mean 'wm'?", "am, gm, hm, wm"]),
            (
                "collaboration.n=4",
                [
                    "--set collaboration.n=4: aggregator: ",
                    "wm has no weights for 4 collaborators (the paper gives 2, 3, 5, 7, 10)",
                ],
            ),
            ("collaboration.n=30", ["collaboration", "30", "25"]),
            ("simulator.step=1", ["simulator.step: unknown option"]),
            ('aggregator.weights=[0.5, "a"]', ['aggregator.weights[1]: expected a number, found "a"']),
            ("simulator.duration=0", ["simulator.duration: must be above 0 and at most 1e9 s, found 0.0"]),
            (
                "simulator.duration=0.03",
                ["--set simulator.duration=0.03: objective: ", "sample 5", "simulator.duration = 0.03 s"],
            ),
            (
                "simulator.voxel_size=1e9",
                ["simulator.voxel_size: must be between 1e-6 and 1e6 m, found 1000000000.0"],
            ),
            (
                "simulator.duration=1e300",
                ["simulator.duration: must be above 0 and at most 1e9 s, found 1e+300"],
            ),
            ("simulator.phase_unit=degrees", ['expected one of "cycles", "radians", found "degrees"']),
            ("objective.last=0", ["objective.last: must be >= 1, found 0"]),
            ("objective.first=7", ["objective: first must come before last"]),
            (
                "populations.morphology.evolver.bias.init_mean=x",
                ["populations.morphology.evolver.bias.init_mean"],
            ),
            (
                "populations.morphology.encoder.canvas=[20, 8]",
                ["canvas: expected a list of 3, found [20, 8]"],
            ),
        ],
    )
    def test_say_what_they_cannot_accept(self, installed: Plugins, override: str, parts: list[str]) -> None:
        with pytest.raises(ConfigurationError) as caught:
            load_config("paper", overrides=[override], plugins=installed)
        for part in parts:
            assert part in str(caught.value)


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
    @pytest.mark.parametrize(
        ("component", "message"),
        [
            (Changeable, "aggregator 'mine' of plugin 'main' of here 1.0 is no frozen attrs class"),
            (Unfinished, "aggregator 'mine' of plugin 'main' of here 1.0 has no check"),
        ],
    )
    def test_are_held_to_their_protocol_when_they_are_chosen(
        self, toy_plugins: Plugins, toy_config: Callable[..., RunConfig], component: type[Any], message: str
    ) -> None:
        toy_plugins.add(plugin(evoframe_aggregators=lambda: {"mine": component}), HERE)
        toy_config()  # as long as nobody asks for it, all is well
        with pytest.raises(ConfigurationError, match=f"--set aggregator=mine: aggregator: {message}"):
            toy_config("aggregator=mine")
