"""Configurations: presets, files, overrides, and every fault in one message."""

from __future__ import annotations

import functools
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import tomli_w
from hypothesis import given, strategies as st

import evoframe
from evoframe import ConfigurationError, RunConfig
from evoframe.config.layers import preset_names
from evoframe.config.resolve import load_config
from evoframe.registry.discovery import discover
from evoframe.registry.registry import Plugins
from evoframe_evolvers import Neat

Load = Callable[..., RunConfig]


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


class TestMerging:
    def test_a_changed_name_drops_the_options_of_the_old_one(self, installed: Plugins) -> None:
        weights = 'aggregator={name="wm", weights=[0.7, 0.3]}'
        config = load_config("paper", overrides=[weights, "aggregator=hm"], plugins=installed)
        assert config.aggregator.name == "hm"
        assert "weights" not in config.tables()["aggregator"]

    def test_the_same_name_keeps_them(self, installed: Plugins) -> None:
        config = load_config(
            "paper", overrides=["simulator.duration=0.08", "simulator=vox"], plugins=installed
        )
        assert config.tables()["simulator"]["duration"] == 0.08

    def test_a_file_starts_from_paper_unless_it_says_otherwise(
        self, installed: Plugins, tmp_path: Path
    ) -> None:
        path = tmp_path / "my.toml"
        path.write_text('[aggregator]\nname = "wm"\nweights = [0.7, 0.3]\n')
        config = load_config(path, plugins=installed)
        assert config.tables()["aggregator"]["weights"] == [0.7, 0.3]
        assert config.run.generations == 200
        assert config.label == "my"
        path.write_text('extends = "quick"\naggregator = "am"\n')
        assert load_config(path, plugins=installed).run.generations == 5

    def test_a_file_may_extend_a_file_beside_it(self, installed: Plugins, tmp_path: Path) -> None:
        (tmp_path / "base.toml").write_text("[run]\ngenerations = 7\n")
        (tmp_path / "top.toml").write_text('extends = "base.toml"\naggregator = "am"\n')
        assert load_config(tmp_path / "top.toml", plugins=installed).run.generations == 7

    def test_what_a_run_wrote_about_itself_is_no_setting(self, toy_config: Load, toy_file: Path) -> None:
        plain = toy_config()
        toy_file.write_text(toy_file.read_text() + '\n[provenance]\nevoframe = "0.1.0"\n')
        assert toy_config() == plain

    @pytest.mark.parametrize(
        ("text", "value"),
        [
            ("2", 2),
            ("0.5", 0.5),
            ("true", True),
            ("hm", "hm"),
            ('"a b"', "a b"),
            ("[1, 2]", [1, 2]),
            ("1e-3", 1e-3),
        ],
    )
    def test_the_right_side_of_set_is_toml_and_a_bare_word_is_a_string(self, text: str, value: Any) -> None:
        from evoframe.config.layers import read_layers  # noqa: PLC0415

        tree = read_layers("paper", overrides=[f"aggregator.x={text}"]).merged()
        assert tree["aggregator"]["x"] == value


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

    def test_a_file_that_is_no_toml_says_where(self, toy_config: Load, toy_file: Path) -> None:
        toy_file.write_text("[run\nseed = 1")
        with pytest.raises(ConfigurationError, match=r"toy\.toml: not valid TOML: .*line 1"):
            toy_config()
        toy_file.write_bytes(b"\xff\xfe")
        with pytest.raises(ConfigurationError, match="not UTF-8"):
            toy_config()

    @pytest.mark.parametrize(
        "text",
        [
            "x = " + "[" * 5000,
            "x = " + "1" * 5000,
            'extends = "a\\u0000.toml"',
            'extends = ""',
            "extends = 3",
            'extends = "."',
        ],
        ids=lambda text: text[:20],
    )
    def test_a_file_that_is_out_of_all_bounds_is_refused(
        self, toy_config: Load, toy_file: Path, text: str
    ) -> None:
        toy_file.write_text(text)
        with pytest.raises(ConfigurationError):
            toy_config()

    def test_a_missing_file_is_named(self, tmp_path: Path, toy_plugins: Plugins) -> None:
        with pytest.raises(ConfigurationError, match=r"nowhere\.toml: cannot be read: No such file"):
            load_config(tmp_path / "nowhere.toml", plugins=toy_plugins)

    def test_an_unknown_preset_offers_those_that_exist(self, toy_plugins: Plugins) -> None:
        with pytest.raises(
            ConfigurationError, match=r"no preset 'papr'; did you mean 'paper'\? presets: authors"
        ):
            load_config("papr", plugins=toy_plugins)

    @pytest.mark.parametrize(
        ("base", "message"),
        [
            ("papr", r"a\.toml: extends: there is no preset 'papr'"),
            ("b.toml", r"a\.toml: extends: .*b\.toml: cannot be read"),
        ],
    )
    def test_what_a_file_extends_in_vain_is_named_with_it(
        self, tmp_path: Path, toy_plugins: Plugins, base: str, message: str
    ) -> None:
        (tmp_path / "a.toml").write_text(f'extends = "{base}"')
        with pytest.raises(ConfigurationError, match=message):
            load_config(tmp_path / "a.toml", plugins=toy_plugins)

    def test_files_that_extend_each_other_are_refused(self, tmp_path: Path, toy_plugins: Plugins) -> None:
        (tmp_path / "a.toml").write_text('extends = "b.toml"')
        (tmp_path / "b.toml").write_text('extends = "a.toml"')
        with pytest.raises(ConfigurationError, match="extends itself"):
            load_config(tmp_path / "a.toml", plugins=toy_plugins)

    def test_a_file_that_extends_itself_by_another_name_is_refused(
        self, tmp_path: Path, toy_plugins: Plugins
    ) -> None:
        (tmp_path / "folder").mkdir()
        (tmp_path / "a.toml").write_text('extends = "folder/../a.toml"')
        with pytest.raises(ConfigurationError, match="extends itself"):
            load_config(tmp_path / "a.toml", plugins=toy_plugins)

    @pytest.mark.parametrize(
        "text",
        [f"[{'a.' * 3000}a]", f"{'a.' * 3000}a = 1", f"a = {'[' * 50}{']' * 50}", "a.b = [{c = [[]]}]"],
    )
    def test_only_deep_tables_and_lists_are_refused_for_their_depth(
        self, toy_config: Load, toy_file: Path, text: str
    ) -> None:
        toy_file.write_text(text)
        expected = "nested more than 32 deep" if len(text) > 30 else "unknown key"
        with pytest.raises(ConfigurationError, match=expected):
            toy_config()

    def test_a_deep_key_is_refused(self, toy_config: Load) -> None:
        with pytest.raises(ConfigurationError, match="nested more than 32 deep"):
            toy_config(f"{'a.' * 3000}a=1")

    def test_a_file_without_end_is_refused(self, toy_plugins: Plugins) -> None:
        with pytest.raises(ConfigurationError, match="/dev/zero: is larger than 16 MiB"):
            load_config("/dev/zero", plugins=toy_plugins)

    @pytest.mark.parametrize("text", ["aggregator", "=hm", "a b=1", "aggregator=[1", "run.seed=1\nrun.x=2"])
    def test_an_override_that_is_none_is_refused(self, toy_config: Load, text: str) -> None:
        with pytest.raises(ConfigurationError, match="--set"):
            toy_config(text)

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
            ("simulator.voxel_size=1e9", ["simulator.voxel_size: must be between 1e-6 and 1e6 m, found 1000000000.0"]),
            ("simulator.duration=1e300", ["simulator.duration: must be above 0 and at most 1e9 s, found 1e+300"]),
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
