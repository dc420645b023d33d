"""Tests of the checks between the components of a configuration."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from toy_capabilities import VARIANTS

from evoframe import ConfigurationError, RunConfig

Variant = Callable[..., RunConfig]


def faults_of(load: Callable[[], object]) -> tuple[ConfigurationError, ...]:
    """Return the faults with which loading a configuration fails."""
    with pytest.raises(ConfigurationError) as caught:
        load()
    return caught.value.faults


WANTING = "populations.{}.evolver={{name='toy-wanting', wants=[{}]}}"
TYPED = "populations.{0}.encoder={{name='toy-typed', role='{0}', {1}}}"
MEASURES = ["simulator=toy-measuring", "objective=toy-second"]

FAULTS: list[tuple[str, list[str], str, str, list[str]]] = [
    (
        "unknown measure",
        [WANTING.format("a", "'hope'")],
        "populations.a.evolver",
        "--set populations.a.evolver",
        ["wants the measure 'hope'", "supplied: age, genome-size, novelty"],
    ),
    (
        "measure of a simulator that is not chosen",
        [WANTING.format("b", "'novelty', 'energy'")],
        "populations.b.evolver",
        "--set populations.b.evolver",
        ["'energy'", "nothing supplies"],
    ),
    (
        "ambiguous measure",
        [
            WANTING.format("b", "'size-of-a'"),
            TYPED.format("a", "needs=[]"),
            "populations.b.encoder={name='toy-typed', role='a'}",
        ],
        "populations.b.evolver",
        "--set populations.b.evolver",
        ["'size-of-a'", "populations.a.encoder, populations.b.encoder"],
    ),
    (
        "another dtype",
        [TYPED.format("a", "dtype='uint8'"), TYPED.format("b", "needs=['a']")],
        "populations.b.encoder",
        "--set populations.b.encoder",
        ["requires float64[1] for the role 'a'", "found uint8[1]"],
    ),
    (
        "another shape",
        [TYPED.format("a", "length=3"), TYPED.format("b", "needs=['a']")],
        "populations.b.encoder",
        "--set populations.b.encoder",
        ["requires float64[1] for the role 'a'", "found float64[3]"],
    ),
    (
        "role of a population that is provided before",
        ["roles.r={provider={name='toy-constant', role='a'}}"],
        "roles.r.provider",
        "--set roles.r",
        ["provides the role 'a', which populations.a.encoder also provides"],
    ),
    (
        "role that is provided after all populations",
        ["roles.r={provider={name='toy-constant', role='b', needs=['a']}}"],
        "roles.r.provider",
        "--set roles.r",
        ["provides the role 'b', which populations.b.encoder also provides"],
    ),
    (
        "roles that provide the same",
        ["roles.r={provider='toy-constant'}", "roles.s={provider='toy-random'}"],
        "roles.r.provider",
        "--set roles.r",
        ["provides the role 'r', which roles.s.provider also provides"],
    ),
    (
        "role that nothing provides",
        ["roles.r={provider={name='toy-constant', needs=['z']}}"],
        "roles.r.provider",
        "--set roles.r",
        ["requires the role 'z', which nothing before it provides"],
    ),
    (
        "role that is provided too late",
        [
            "roles.r={provider={name='toy-constant', needs=['a']}}",
            "populations.b.encoder={name='toy-number', role='b', needs=['r']}",
        ],
        "populations.b.encoder",
        "--set populations.b.encoder",
        ["requires the role 'r', which nothing before it provides"],
    ),
    (
        "turns with parallel timing",
        ["run.timing=parallel", "populations.b.turns=2"],
        "populations.b.turns",
        "--set populations.b.turns=2",
        ["expected 1 with run.timing = 'parallel'", "found 2"],
    ),
    (
        "number that the own aggregator refuses",
        ["collaboration.n=3", "populations.b.aggregator={name='toy-mean'}", "populations.a.size=20",
         "populations.b.collaboration={name='toy-first', n=9}"],
        "populations.b.aggregator",
        "--set populations.b.collaboration",
        ["9 scores exceed the 8"],
    ),
    (
        "number of the own strategy that the common aggregator refuses",
        ["populations.a.size=20", "populations.b.collaboration={name='toy-first', n=9}"],
        "aggregator",
        "--set populations.b.collaboration",
        ["9 scores exceed the 8"],
    ),
    (
        "more collaborators than members",
        ["populations.b.collaboration={name='toy-first', n=7}"],
        "populations.b.collaboration",
        "--set populations.b.collaboration",
        ["7 collaborators of 6 members", "population 'a'"],
    ),
    (
        "goal",
        ["populations.a.goal=up"],
        "populations.a.goal",
        "--set populations.a.goal=up",
        ['"maximize", "minimize"', '"up"'],
    ),
    (
        "all minimize",
        ["populations.a.goal=minimize", "populations.b.goal=minimize"],
        "populations.a.goal",
        "--set populations.a.goal=minimize",
        ["opposite sign"],
    ),
    ("turns", ["populations.a.turns=0"], "populations.a.turns", "--set populations.a.turns=0", ["0"]),
    ("timing", ["run.timing=never"], "run.timing", "--set run.timing=never", ['"parallel"', '"never"']),
    (
        "draw",
        ["roles.r={provider='toy-random', draw='often'}"],
        "roles.r.draw",
        "--set roles.r",
        ['"individual"', '"often"'],
    ),
    (
        "unknown provider",
        ["roles.r={provider='toy-rndom'}"],
        "roles.r.provider",
        "--set roles.r",
        ["unknown role 'toy-rndom'", "'toy-random'"],
    ),
    ("no provider", ["roles.r={draw='turn'}"], "roles.r.provider", "--set roles.r", ["missing", "toy-ra"]),
    ("roles", ["roles=5"], "roles", "--set roles=5", ["tables [roles.NAME]", "5"]),
    ("role", ["roles.r=5"], "roles.r", "--set roles.r=5", ["a table", "5"]),
    ("name of a role", ["roles.R={provider='toy-random'}"], "roles.R", "--set roles.R", ["'R'", "lower"]),
    (
        "nested strategy",
        ["collaboration={name='toy-outer', inner='toy-fist'}"],
        "collaboration.inner",
        "--set collaboration=",
        ["unknown collaboration strategy 'toy-fist'", "'toy-first'"],
    ),
    (
        "nested strategy in a list",
        ["collaboration={name='toy-outer', inner='toy-first', more=['toy-last', 'worse']}"],
        "collaboration.more[1]",
        "--set collaboration=",
        ["unknown collaboration strategy 'worse'"],
    ),
    (
        "option of a nested strategy",
        ["collaboration={name='toy-outer', inner={name='toy-first', n=0}}"],
        "collaboration.inner.n",
        "--set collaboration=",
        [">= 1", "found 0"],
    ),
    (
        "nested component of another kind",
        ["collaboration={name='toy-outer', inner='toy-mean'}"],
        "collaboration.inner",
        "--set collaboration=",
        ["unknown collaboration strategy 'toy-mean'", "'aggregator=toy-mean'"],
    ),
    (
        "nested number",
        ["collaboration={name='toy-outer', inner=5}"],
        "collaboration.inner",
        "--set collaboration=",
        ["table with the key 'name'", "found 5"],
    ),
    (
        "nested strategy that is missing",
        ["collaboration={name='toy-outer'}"],
        "collaboration.inner",
        "--set collaboration=",
        ["missing"],
    ),
    (
        "nested strategy with too many collaborators",
        ["collaboration={name='toy-outer', inner={name='toy-first', n=6}}"],
        "collaboration",
        "--set collaboration=",
        ["6 collaborators of 5 members", "population 'b'"],
    ),
]  # fmt: skip


@pytest.mark.parametrize(
    ("overrides", "key", "source", "parts"), [each[1:] for each in FAULTS], ids=[each[0] for each in FAULTS]
)
def test_a_fault_has_its_origin_its_key_and_the_value(
    toy_variant: Variant, tmp_path: Path, overrides: list[str], key: str, source: str, parts: list[str]
) -> None:
    faults = faults_of(lambda: toy_variant("sequential", *overrides))
    [fault] = [each for each in faults if each.key == key]
    assert fault.source.startswith(source or str(tmp_path))
    assert all(part in fault.problem for part in parts), fault.problem
    assert len(faults) == 1 or key.startswith(("collaboration", "populations.b.evolver"))


@pytest.mark.parametrize("name", VARIANTS)
def test_valid_configurations_have_no_fault(toy_variant: Variant, name: str) -> None:
    assert toy_variant(name).populations


class TestNumbersOfCollaborators:
    def test_of_populations_of_different_sizes_must_be_equal_with_three(self, toy_variant: Variant) -> None:
        [fault] = faults_of(lambda: toy_variant("three", "collaboration=toy-everyone"))
        assert fault.key == "collaboration"
        assert "different sizes give different numbers of collaborators: 4, 5, 6" in fault.problem

    def test_may_depend_on_the_size_with_two(self, toy_variant: Variant) -> None:
        toy_variant("sequential", "collaboration=toy-everyone")

    def test_may_depend_on_the_size_if_the_others_are_equal(self, toy_variant: Variant) -> None:
        toy_variant("three", "populations.b.size=4", "populations.a.collaboration=toy-everyone")
        [fault] = faults_of(
            lambda: toy_variant("three", "populations.b.size=4", "populations.b.collaboration=toy-everyone")
        )
        assert fault.key == "populations.b.collaboration"

    def test_are_those_from_the_other_population_only(self, toy_variant: Variant) -> None:
        """The individuals of a meet the five of b; toy-mean would refuse the nine of a."""
        settings = ["populations.a.size=9", "populations.a.collaboration=toy-everyone"]
        toy_variant("sequential", *settings)
        settings = ["populations.a.size=9", "collaboration=toy-everyone"]
        [fault] = faults_of(lambda: toy_variant("sequential", *settings))
        assert (fault.key, fault.problem) == ("aggregator", "9 scores exceed the 8 of toy-mean")
        toy_variant("sequential", *settings, "populations.b.aggregator=toy-share")

    def test_do_not_matter_to_a_population_alone(self, toy_variant: Variant) -> None:
        """Its individuals meet nobody, and have one score."""
        toy_variant("one", "collaboration.n=30")

    def test_are_not_checked_if_another_population_is_invalid(self, toy_variant: Variant) -> None:
        faults = faults_of(lambda: toy_variant("sequential", "populations.b.size=1", "collaboration.n=5"))
        assert [fault.key for fault in faults] == ["populations.b.size"]


def test_measures_are_not_checked_if_a_supplier_is_invalid(toy_variant: Variant) -> None:
    faults = faults_of(
        lambda: toy_variant("measures", "simulator.limit=far", "populations.a.evolver.wants=['energy']")
    )
    assert [fault.key for fault in faults] == ["simulator.limit"]
