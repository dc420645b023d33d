"""Tests of the resolved configuration: its tables, and those that determine a run."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Callable
from typing import Any, cast

import attrs
import pytest
import toys
from hypothesis import given, strategies as st

from evoframe import ADDED_LATER, Chosen, RunConfig, RunSettings, Source
from evoframe.contract.config import COMPONENTS, is_role

Load = Callable[..., RunConfig]


def test_its_text_contains_its_tables(toy_config: Load) -> None:
    config = toy_config("simulator.limit=2.5", "populations.b.encoder.needs=['a']")
    tables = tomllib.loads(config.to_toml())
    assert tables == config.tables()
    assert tables["simulator"] == {"name": "toy-product", "limit": 2.5}
    assert tables["populations"]["b"]["encoder"] == {"name": "toy-number", "role": "b", "needs": ["a"]}
    assert tables["extends"] is False  # the configuration is complete, so it extends nothing


def test_every_option_is_written(toy_config: Load) -> None:
    """A version with other defaults reads the same configuration."""
    for key, chosen in toy_config().components():
        table: Any = toy_config().tables()
        for part in key.split("."):
            table = table[part]
        fields = {field.name for field in attrs.fields(type(chosen.component))}
        assert table.keys() == {"name", *fields}


def test_components_come_with_their_keys_populations_first(toy_config: Load) -> None:
    config = toy_config()
    keys = [key for key, _ in config.components()]
    roles = [f"populations.{role}.{key}" for role in "ab" for key in ("encoder", "evolver")]
    assert keys == [*roles, *COMPONENTS]
    assert dict(config.components())["simulator"] is config.simulator


def test_only_the_executor_does_not_determine_the_result(toy_config: Load) -> None:
    config = toy_config()
    other = attrs.evolve(config, executor=Chosen("toy-many", toys.Many(), config.executor.source))
    assert other.tables() != config.tables()
    assert other.deciding() == config.deciding()
    assert config.deciding().keys() == {"run", "populations", "plugins", *COMPONENTS} - {"executor"}
    longer = attrs.evolve(config, run=attrs.evolve(config.run, generations=5))
    assert longer.deciding() != config.deciding()


@attrs.frozen
class Grown(toys.Product):
    """A simulator with an option that it received later."""

    strength: float = attrs.field(default=1.0, metadata=ADDED_LATER)


def test_an_option_added_later_counts_only_if_it_differs_from_its_default(toy_config: Load) -> None:
    config = toy_config()

    def grown(**options: float) -> RunConfig:
        component = Grown(**attrs.asdict(cast("Any", config.simulator.component)), **options)
        return attrs.evolve(config, simulator=attrs.evolve(config.simulator, component=component))

    assert grown().deciding() == config.deciding()
    assert grown().simulation() == config.simulation()
    assert grown().tables()["simulator"]["strength"] == 1.0
    assert grown(strength=2.0).deciding()["simulator"]["strength"] == 2.0
    assert grown(strength=2.0).simulation()["simulator"]["strength"] == 2.0


def test_an_earlier_configuration_is_recorded_as_before(toy_config: Load) -> None:
    """Options that are newer than the record of a run are left out while they have their defaults."""
    recorded = toy_config().recorded()
    assert recorded["run"] == {"seed": 3, "generations": 4}
    for population in recorded["populations"].values():
        assert population.keys() == {"size", "encoder", "evolver"}
    assert recorded.keys() == {"extends", "run", "populations", "plugins", *COMPONENTS}


@pytest.mark.parametrize(
    ("override", "path", "value"),
    [
        ("run.timing=parallel", ("run", "timing"), "parallel"),
        ("populations.a.goal=minimize", ("populations", "a", "goal"), "minimize"),
        ("populations.b.turns=2", ("populations", "b", "turns"), 2),
        (
            "populations.b.aggregator=toy-share",
            ("populations", "b", "aggregator"),
            {"name": "toy-share"},
        ),
        (
            "populations.b.collaboration.name=toy-first",
            ("populations", "b", "collaboration"),
            {"name": "toy-first", "n": 2},
        ),
        (
            "roles.r.provider=toy-random",
            ("roles", "r"),
            {"provider": {"name": "toy-random", "role": "r", "value": 2.0, "needs": []}, "draw": "run"},
        ),
    ],
)
def test_newer_options_determine_the_result_if_they_are_used(
    toy_config: Load, override: str, path: tuple[str, ...], value: Any
) -> None:
    found: Any = toy_config(override).deciding()
    assert found != toy_config().deciding()
    for key in path:
        found = found[key]
    assert found == value


class TestComponentsOfPopulations:
    def test_replace_those_of_the_run(self, toy_config: Load) -> None:
        config = toy_config("populations.b.aggregator=toy-share", "populations.a.collaboration=toy-last")
        assert config.chosen_for("a", "aggregator") == ("aggregator", config.aggregator)
        key, chosen = config.chosen_for("b", "aggregator")
        assert (key, chosen.component) == ("populations.b.aggregator", toys.Share())
        key, chosen = config.chosen_for("a", "collaboration")
        assert (key, chosen.component) == ("populations.a.collaboration", toys.Last())
        assert config.chosen_for("b", "collaboration") == ("collaboration", config.collaboration)

    def test_are_listed_with_their_keys(self, toy_config: Load) -> None:
        config = toy_config("populations.b.aggregator=toy-share", "roles.r.provider=toy-random")
        keys = [key for key, _ in config.components()]
        added = {"populations.b.aggregator", "roles.r.provider"}
        assert set(keys) - {key for key, _ in toy_config().components()} == added
        assert len(keys) == len(set(keys))


class TestNestedComponents:
    outer = "collaboration={name='toy-outer', inner={name='toy-first', n=1}, more=['toy-last', 'toy-drawn']}"

    def test_are_listed_with_their_keys(self, toy_config: Load) -> None:
        components = dict(toy_config(self.outer).components())
        assert [key for key in components if key.startswith("collaboration")] == [
            "collaboration",
            "collaboration.inner",
            "collaboration.more[0]",
            "collaboration.more[1]",
        ]
        assert components["collaboration.inner"].component == toys.First(n=1)
        assert components["collaboration.more[1]"].name == "toy-drawn"

    def test_are_written_as_tables(self, toy_config: Load) -> None:
        assert toy_config(self.outer).tables()["collaboration"] == {
            "name": "toy-outer",
            "inner": {"name": "toy-first", "n": 1},
            "more": [{"name": "toy-last"}, {"name": "toy-drawn"}],
        }


def test_deciding_tables_are_json_values(toy_config: Load) -> None:
    deciding = toy_config("populations.b.encoder.needs=['a']").deciding()
    assert json.loads(json.dumps(deciding)) == deciding


def test_configurations_with_different_labels_are_equal(toy_config: Load) -> None:
    assert attrs.evolve(toy_config(), label="other") == toy_config()


def test_the_simulation_depends_on_simulator_and_objective(toy_config: Load) -> None:
    config = toy_config("objective={name='toy-late', until=0.5}")
    assert config.simulation() == {
        "simulator": {"name": "toy-product", "limit": 1e9},
        "objective": {"name": "toy-late", "until": 0.5},
    }


@pytest.mark.parametrize("settings", [{"seed": -1}, {"generations": -1}])
def test_neither_seed_nor_length_is_negative(settings: dict[str, Any]) -> None:
    with pytest.raises(ValueError, match=f"'{next(iter(settings))}'.*-1"):
        RunSettings(**settings)


@given(st.from_regex(r"[a-z][a-z0-9_-]{0,9}", fullmatch=True))
def test_a_word_is_a_valid_name_of_a_population(name: str) -> None:
    assert is_role(name)


@given(st.text(max_size=6), st.characters(exclude_characters="abcdefghijklmnopqrstuvwxyz0123456789_-"))
def test_other_characters_are_refused_in_names_of_populations(text: str, strange: str) -> None:
    for name in (text + strange, strange + text, f"a{strange}b", f"a{strange}"):
        assert not is_role(name)


@pytest.mark.parametrize("name", ["", "1a", "-a", "_a", "A", "a\n", 'a"', "a b", "ä"])
def test_an_invalid_name_of_a_population_is_refused(name: str) -> None:
    assert not is_role(name)


def test_a_source_is_named_with_its_plugin() -> None:
    assert str(Source("evoframe", "0.1.0", "simulators")) == "'simulators' of evoframe 0.1.0"
