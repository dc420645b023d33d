"""Tests of errors: their texts, their data, and pickling."""

from __future__ import annotations

import pickle
from pathlib import Path
from typing import Any

import attrs
import pytest

from evoframe import errors
from evoframe.errors import (
    ComponentError,
    ConfigurationError,
    EvoframeError,
    InputError,
    NotEmptyError,
    OccupiedError,
    RunError,
    WorkerError,
)
from evoframe.messages import full_text


def test_a_component_error_can_be_pickled() -> None:
    error = ComponentError("simulator", "failed", "a 1 with b 2", keys=(b"key",))
    copied = pickle.loads(pickle.dumps(error))  # noqa: S301 - pickled above
    assert (str(copied), copied.keys) == ("simulator: failed (a 1 with b 2)", (b"key",))


def test_the_text_of_a_component_error_contains_its_data() -> None:
    error = ComponentError("simulator", "failed")
    assert str(error) == "simulator: failed"
    known = attrs.evolve(error, offered="'vox'", concerns="a 1 with b 2")
    assert str(known) == "simulator: 'vox': failed (a 1 with b 2)"
    assert str(error) == "simulator: failed"  # unchanged


def test_a_component_error_cannot_be_changed() -> None:
    error: Any = ComponentError("simulator", "failed")
    with pytest.raises(attrs.exceptions.FrozenInstanceError):
        error.problem = "succeeded"


def test_a_component_error_can_be_raised_and_have_notes() -> None:
    with pytest.raises(RunError) as caught:
        raise ComponentError("simulator", "failed")
    caught.value.add_note("try again")
    assert full_text(caught.value) == "simulator: failed\n  try again"


def test_a_worker_error_has_its_item() -> None:
    error = WorkerError("took too long", 7)
    assert (str(error), error.problem, error.item) == ("took too long", "took too long", 7)


@pytest.mark.parametrize("name", [name for name in errors.__all__ if name.endswith("Error")])
def test_all_errors_have_a_common_base(name: str) -> None:
    assert issubclass(getattr(errors, name), EvoframeError)


@pytest.mark.parametrize(
    ("data", "text"),
    [
        ({}, "is missing"),
        ({"source": Path("a.toml")}, "a.toml: is missing"),
        ({"key": "run.seed"}, "run.seed: is missing"),
        ({"source": "--set x", "key": "run.seed"}, "--set x: run.seed: is missing"),
    ],
)
def test_the_text_of_an_error_begins_with_source_and_key(data: dict[str, Any], text: str) -> None:
    error = InputError("is missing", **data)
    assert str(error) == text
    assert (error.source, error.key) == (str(data.get("source", "")), data.get("key", ""))


def test_an_error_can_be_pickled_with_its_data() -> None:
    error = InputError("is missing", source="a.toml", key="run.seed")
    copied = pickle.loads(pickle.dumps(error))  # noqa: S301 - pickled above
    assert (copied.problem, copied.source, copied.key) == ("is missing", "a.toml", "run.seed")


def test_a_configuration_error_lists_its_faults() -> None:
    single = ConfigurationError("is missing", key="run.seed")
    assert single.faults == (single,)
    both = ConfigurationError("2 faults:", faults=[single, single])
    assert both.faults == (single, single)
    assert str(both).splitlines() == ["2 faults:", *2 * [f"  {single}"]]


def test_an_occupied_directory_is_not_empty() -> None:
    """A handler of NotEmptyError also handles OccupiedError."""
    assert OccupiedError.__mro__[1:4] == (NotEmptyError, InputError, EvoframeError)
