"""Tests of the hints for unknown keys and misplaced names."""

from __future__ import annotations

import functools
from collections.abc import Callable

import pytest
from hypothesis import given, strategies as st

from evoframe import ConfigurationError, RunConfig
from evoframe.config.hints import SECTIONS, known_keys, similar_keys
from evoframe.config.layers import read_layers
from evoframe.config.resolve import load_config
from evoframe.documents import leaves
from evoframe.registry import Plugins, discover

Load = Callable[..., RunConfig]


@functools.cache
def installed() -> Plugins:
    return discover()


def keys_of(*overrides: str) -> list[str]:
    return known_keys(read_layers("paper", overrides).merged(), installed())


def fault_of(override: str) -> ConfigurationError:
    """Return the only fault of the preset ``paper`` with an override."""
    with pytest.raises(ConfigurationError) as caught:
        load_config("paper", overrides=[override], plugins=installed())
    [fault] = caught.value.faults
    return fault


def test_every_option_of_a_configuration_is_known() -> None:
    config = load_config("paper", plugins=installed())
    stated = {key for key, _ in leaves(config.tables()) if not key.endswith(".name")} - {"extends"}
    assert stated <= set(keys_of())


def test_options_belong_to_the_chosen_components() -> None:
    assert "aggregator.weights" in keys_of()
    assert "aggregator.weights" not in keys_of("aggregator=hm")
    assert "aggregator" in keys_of("aggregator=nobody")


@pytest.mark.parametrize("tree", [{}, {"populations": 3}, {"populations": {"a": 3}}, {"simulator": 3}])
def test_invalid_tables_have_no_options(tree: dict[str, object]) -> None:
    expected = {*SECTIONS, "run.seed", "run.generations", "run.timing", "plugins.block", "plugins.require"}
    assert set(known_keys(tree, installed())) == expected


POPULATIONS = ("morphology", "controller")


@pytest.mark.parametrize(
    ("override", "key", "meant"),
    [
        ("generations=3", "generations", ["run.generations"]),
        ("generatons=3", "generatons", ["run.generations"]),
        ("n=5", "n", ["collaboration.n"]),
        ("seed=2", "seed", ["run.seed"]),
        ("worker=2", "worker", ["executor.workers"]),
        ("agregator=5", "agregator", ["aggregator"]),
        ("agregator=hm", "agregator", ["aggregator=hm"]),
        ("simulater.duration=1", "simulater", ["simulator"]),
        ("size=10", "size", [f"populations.{role}.size" for role in POPULATIONS]),
        ("evolver=neat", "evolver", [f"populations.{role}.evolver" for role in POPULATIONS]),
        ("evolver.elitism=1", "evolver", [f"populations.{role}.evolver.elitism" for role in POPULATIONS]),
        ("morphology.size=10", "morphology", ["populations.morphology.size"]),
        ("strategy=worst", "strategy", ["collaboration=worst"]),
        ("strategy=wurst", "strategy", ["collaboration"]),
        ("averaging=hm", "averaging", ["aggregator=hm"]),
        ("run.n=5", "run.n", ["collaboration.n"]),
        ("run.size=8", "run.size", [f"populations.{role}.size" for role in POPULATIONS]),
        ("collaboration.generations=3", "collaboration.generations", ["run.generations"]),
        ("populations.size=10", "populations.size", [f"populations.{role}.size" for role in POPULATIONS]),
        ("aggregator=worst", "aggregator", ["collaboration=worst"]),
        ("collaboration=hm", "collaboration", ["aggregator=hm"]),
        ("simulator=neat", "simulator", ["populations.ROLE.evolver=neat"]),
    ],
)
def test_an_unknown_key_or_name_is_answered_with_the_right_one(
    override: str, key: str, meant: list[str]
) -> None:
    fault = fault_of(override)
    assert (fault.source, fault.key) == (f"--set {override}", key)
    question = fault.problem.partition("did you mean ")[2].partition("?")[0]
    assert question.split(" or ") == [f"'{each}'" for each in meant]


def test_an_unfamiliar_key_is_answered_with_all_sections() -> None:
    problem = fault_of("zzz=1").problem
    assert "did you mean" not in problem
    assert all(section in problem for section in SECTIONS)


def test_the_valid_options_of_a_table_are_listed_with_a_hint() -> None:
    assert fault_of("run.n=5").problem.endswith("options: seed, generations, timing")


def test_at_most_four_keys_are_suggested(toy_config: Load) -> None:
    more = [f"populations.{role}.encoder.name=toy-number" for role in "cdefg"]
    with pytest.raises(ConfigurationError) as caught:
        toy_config("size=3", *more)
    [fault] = [fault for fault in caught.value.faults if fault.key == "size"]
    assert [f"populations.{role}.size" in fault.problem for role in "abcdefg"] == [True] * 4 + [False] * 3


@given(st.deferred(lambda: st.sampled_from(keys_of())))
def test_a_known_key_is_similar_to_itself(key: str) -> None:
    assert key in similar_keys(key, keys_of())
    last = key.rpartition(".")[2]
    assert similar_keys(last, keys_of()) == [last] or key in similar_keys(last, keys_of())


@given(st.text("abcdefghijklmnopqrstuvwxyz_.", min_size=1, max_size=12))
def test_only_known_keys_are_suggested(key: str) -> None:
    assert set(similar_keys(key, keys_of())) <= set(keys_of())


def test_a_kind_is_suggested_only_if_its_key_is_known() -> None:
    assert similar_keys("strategi", ["run", "collaboration"]) == ["collaboration"]
    assert similar_keys("strategi", ["run"]) == []
