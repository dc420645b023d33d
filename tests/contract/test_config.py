"""The value of a configuration: its tables, and which of them decide a run."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Callable
from typing import Any

import attrs
import pytest
import toys
from hypothesis import given, strategies as st

from evoframe import Chosen, RunConfig, RunSettings, Source
from evoframe.contract.config import COMPONENTS, POPULATION_COMPONENTS, is_role

Load = Callable[..., RunConfig]


def test_its_text_is_its_tables(toy_config: Load) -> None:
    config = toy_config("simulator.limit=2.5", "populations.b.encoder.needs=['a']")
    tables = tomllib.loads(config.to_toml())
    assert tables == config.tables()
    assert tables["simulator"] == {"name": "toy-product", "limit": 2.5}
    assert tables["populations"]["b"]["encoder"] == {"name": "toy-number", "role": "b", "needs": ["a"]}
    assert tables["extends"] is False  # it is complete: it must not make anybody read another file


def test_every_option_is_written_out(toy_config: Load) -> None:
    """So that another version with other defaults makes the same of it."""
    for key, chosen in toy_config().components():
        table: Any = toy_config().tables()
        for part in key.split("."):
            table = table[part]
        fields = {field.name for field in attrs.fields(type(chosen.component))}
        assert table.keys() == {"name", *fields}


def test_components_come_with_their_keys_populations_first(toy_config: Load) -> None:
    config = toy_config()
    keys = [key for key, _ in config.components()]
    roles = [f"populations.{role}.{key}" for role in "ab" for key in POPULATION_COMPONENTS]
    assert keys == [*roles, *COMPONENTS]
    assert dict(config.components())["simulator"] is config.simulator


def test_the_executor_alone_decides_nothing(toy_config: Load) -> None:
    config = toy_config()
    other = attrs.evolve(config, executor=Chosen("toy-many", toys.Many(), config.executor.source))
    assert other.tables() != config.tables()
    assert other.deciding() == config.deciding()
    assert config.deciding().keys() == {"run", "populations", "plugins", *COMPONENTS} - {"executor"}
    longer = attrs.evolve(config, run=attrs.evolve(config.run, generations=5))
    assert longer.deciding() != config.deciding()


def test_what_decides_is_as_it_is_read_back(toy_config: Load) -> None:
    deciding = toy_config("populations.b.encoder.needs=['a']").deciding()
    assert json.loads(json.dumps(deciding)) == deciding


def test_a_label_does_not_make_another_configuration(toy_config: Load) -> None:
    assert attrs.evolve(toy_config(), label="other") == toy_config()


def test_a_design_is_simulated_as_simulator_and_objective_say(toy_config: Load) -> None:
    config = toy_config("objective={name='toy-late', until=0.5}")
    assert config.simulation() == {
        "simulator": {"name": "toy-product", "limit": 1e9},
        "objective": {"name": "toy-late", "until": 0.5},
    }


@pytest.mark.parametrize("settings", [{"seed": -1}, {"generations": -1}])
def test_neither_seed_nor_length_is_negative(settings: dict[str, int]) -> None:
    with pytest.raises(ValueError, match=f"'{next(iter(settings))}' must be >= 0: -1"):
        RunSettings(**settings)


@given(st.from_regex(r"[a-z][a-z0-9_-]{0,9}", fullmatch=True))
def test_a_population_may_be_called_with_a_word(name: str) -> None:
    assert is_role(name)


@given(st.text(max_size=6), st.characters(exclude_characters="abcdefghijklmnopqrstuvwxyz0123456789_-"))
def test_a_population_may_not_be_called_with_what_could_end_a_name_of_a_column(
    text: str, strange: str
) -> None:
    for name in (text + strange, strange + text, f"a{strange}b", f"a{strange}"):
        assert not is_role(name)


@pytest.mark.parametrize("name", ["", "1a", "-a", "_a", "A", "a\n", 'a"', "a b", "ä"])
def test_what_is_no_word_is_no_name_of_a_population(name: str) -> None:
    assert not is_role(name)


def test_a_source_is_named_with_its_plugin() -> None:
    assert str(Source("evoframe", "0.1.0", "simulators")) == "'simulators' of evoframe 0.1.0"
