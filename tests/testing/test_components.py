import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar

import attrs
import pytest
from attrs import validators
from processes import python

from evoframe import Chosen, CollaborationStrategy, Source, StructureError, discover, testing
from evoframe.testing.components import ComponentContract

FROZEN = "test_it_is_a_frozen_attrs_class"
EXPLAINED = "test_options_have_a_type_and_a_default_or_an_explanation"
DEFAULTS = "test_defaults_are_valid"
SURVIVES = "test_options_survive_a_configuration_file"
NUMBERED = "test_a_bit_generation_is_a_number_from_1"


@attrs.frozen
class Plain:
    """A component that does not explain its option."""

    n: int = 2


@attrs.frozen
class NoOptions:
    """A component without options."""


@attrs.frozen
class Explained:
    """A component with an option.

    Attributes:
        n: Has no default.
    """

    n: int


@attrs.define
class Mutable:
    n: int = 2


@dataclass(frozen=True)
class NotAttrs:
    n: int = 2


@attrs.frozen
class Unexplained:
    """A component with an unexplained option."""

    n: int


@attrs.frozen
class Untyped:
    """A component with an option without a type."""

    n = attrs.field(default=2)  # type: ignore[var-annotated]  # the fault under test


@attrs.frozen
class RefusedDefault:
    """A component whose default is refused by its own validator."""

    n: int = attrs.field(default=0, validator=validators.ge(1))


@attrs.frozen
class CannotBeWritten:
    """A component with an option that cannot be written to a configuration file."""

    n: complex = 1j


@attrs.frozen
class Numbered:
    """A component that states the generation of its results."""

    bit_generation: ClassVar[Any] = 2


@attrs.frozen
class NumberedInWords(Numbered):
    """A component that states it in words."""

    bit_generation: ClassVar[Any] = "two"


@attrs.frozen
class NumberedFromZero(Numbered):
    """A component that counts from 0."""

    bit_generation: ClassVar[Any] = 0


@attrs.frozen(eq=False)
class NeverEqual:
    """A component that differs from its own copy."""

    n: int = 2


@attrs.frozen
class Combining:
    """A component with components of plugins among its options.

    Attributes:
        one: One of them.
        several: More of them.
    """

    one: Chosen[CollaborationStrategy]
    several: tuple[Chosen[CollaborationStrategy], ...]


def strategy(name: str, **options: Any) -> Chosen[CollaborationStrategy]:
    """Return a strategy of an installed plugin."""
    offer = discover().find("strategy", name)
    return Chosen(name, offer.component(**options), offer.source)


def renamed(chosen: Chosen[CollaborationStrategy]) -> Chosen[CollaborationStrategy]:
    return attrs.evolve(chosen, name="nobody-offers-this")


COMBINING = Combining(strategy("random", n=1), (strategy("fittest", n=3), strategy("worst")))


@pytest.mark.parametrize(
    "component",
    [Plain(), Plain(n=3), NoOptions(), Explained(n=1), Numbered(), COMBINING],
    ids=lambda component: type(component).__name__,
)
def test_a_sound_component_passes(
    component: Any, keeps: Callable[..., None], laws: Callable[..., list[str]]
) -> None:
    for law in laws(ComponentContract):
        keeps(ComponentContract, component, law)


@pytest.mark.parametrize(
    ("component", "law"),
    [
        (Mutable(), FROZEN),
        (NotAttrs(), FROZEN),
        (Unexplained(n=1), EXPLAINED),
        (Untyped(), EXPLAINED),
        (NeverEqual(), SURVIVES),
        (NumberedInWords(), NUMBERED),
        (NumberedFromZero(), NUMBERED),
    ],
    ids=str,
)
def test_an_unsound_component_is_caught(component: Any, law: str, breaks: Callable[..., None]) -> None:
    breaks(ComponentContract, component, law)


def test_an_invalid_default_is_caught(breaks: Callable[..., None]) -> None:
    breaks(ComponentContract, RefusedDefault(n=1), DEFAULTS, error=ValueError)


def test_a_component_among_the_options_that_no_plugin_offers_is_caught(breaks: Callable[..., None]) -> None:
    unknown = attrs.evolve(COMBINING, several=(strategy("fittest"), renamed(strategy("worst"))))
    breaks(ComponentContract, unknown, SURVIVES, error=StructureError)


def test_another_source_of_a_component_among_the_options_is_caught(breaks: Callable[..., None]) -> None:
    elsewhere = Chosen("random", COMBINING.one.component, Source("other", "1.0", "strategies"))
    breaks(ComponentContract, attrs.evolve(COMBINING, one=elsewhere), SURVIVES)


def test_an_option_that_cannot_be_written_is_caught(breaks: Callable[..., None]) -> None:
    breaks(ComponentContract, CannotBeWritten(), SURVIVES, error=Exception)


@pytest.mark.parametrize("name", testing.__all__)
def test_a_component_of_a_different_kind_is_caught(name: str, breaks: Callable[..., None]) -> None:
    breaks(getattr(testing, name), NoOptions(), "test_it_implements_its_protocol")


@pytest.mark.parametrize("name", testing.__all__)
def test_every_law_is_explained(name: str, laws: Callable[..., list[str]]) -> None:
    contract = getattr(testing, name)
    for law in laws(contract):
        assert getattr(contract, law).__doc__, law


@pytest.mark.parametrize("missing", ["hypothesis", "pytest"])
def test_without_its_extra_the_package_names_the_command_that_installs_it(missing: str) -> None:
    code = f"import sys; sys.modules['{missing}'] = None; import evoframe.testing"
    ended = python("-c", code)
    assert ended.returncode == 1
    message = ended.stderr.splitlines()[-1]
    assert message.startswith("ImportError: evoframe.testing ")
    assert "pytest and hypothesis" in message
    assert message.endswith(" pip install '.[testing]'")


def test_contracts_work_in_a_plugins_own_test_suite(tmp_path: Any) -> None:
    """Several subclasses work in one session with warnings as errors; a failure shows the compared values."""
    (tmp_path / "test_plugin.py").write_text(PLUGIN_TESTS)
    options = ["-W", "error", "-p", "no:cacheprovider", "-k", "within_the_scores or irrelevant"]
    options += ["--hypothesis-seed", "1"]  # other seeds find both failures at once, and report a group
    ended = python("-m", "pytest", *options, tmp_path)
    assert "TestSum::test_the_result_lies_within_the_scores" in ended.stdout
    assert "TestMean::" not in ended.stdout
    assert "TestMax::" not in ended.stdout
    assert re.search(r"(Falsifying example|Failing test case): law\(", ended.stdout)
    assert "+  where" in ended.stdout
    assert "AssertionError: bounded: " in ended.stdout


PLUGIN_TESTS = """
import math
import attrs
from evoframe.testing import AggregatorContract

@attrs.frozen
class Max:
    domain = (-1e100, 1e100)

    def check(self, n):
        from evoframe import ConfigurationError
        if n < 1:
            raise ConfigurationError(f"{n}")

    def aggregate(self, scores):
        return float(max(scores))

class Mean(Max):
    def aggregate(self, scores):
        return math.fsum(scores) / len(scores)

class Sum(Max):
    def aggregate(self, scores):
        return math.fsum(scores)

class TestMax(AggregatorContract):
    component = Max()

class TestMean(AggregatorContract):
    component = Mean()

class TestSum(AggregatorContract):
    component = Sum()
"""
