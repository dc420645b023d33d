"""Errors say what happened, and keep saying it on their way."""

from __future__ import annotations

import pickle
from typing import Any

import attrs
import pytest

from evoframe import errors
from evoframe.errors import (
    ComponentError,
    EvoframeError,
    InputError,
    NotEmptyError,
    OccupiedError,
    RunError,
    WorkerError,
)
from evoframe.messages import full_text


def test_a_fault_of_a_component_passes_between_processes_with_all_that_it_says() -> None:
    error = ComponentError("simulator", "failed", "a 1 with b 2", keys=(b"key",))
    copied = pickle.loads(pickle.dumps(error))  # noqa: S301 - our own
    assert (str(copied), copied.keys) == ("simulator: failed (a 1 with b 2)", (b"key",))


def test_a_fault_of_a_component_is_said_with_all_that_is_known() -> None:
    error = ComponentError("simulator", "failed")
    assert str(error) == "simulator: failed"
    known = attrs.evolve(error, offered="'vox'", concerns="a 1 with b 2")
    assert str(known) == "simulator: 'vox': failed (a 1 with b 2)"
    assert str(error) == "simulator: failed"  # which is another


def test_a_fault_of_a_component_cannot_be_changed() -> None:
    error: Any = ComponentError("simulator", "failed")
    with pytest.raises(attrs.exceptions.FrozenInstanceError):
        error.problem = "did well"


def test_a_fault_of_a_component_can_be_raised_and_have_hints() -> None:
    with pytest.raises(RunError) as caught:
        raise ComponentError("simulator", "failed")
    caught.value.add_note("try again")
    assert full_text(caught.value) == "simulator: failed\n  try again"


def test_a_lost_worker_says_with_what() -> None:
    error = WorkerError("took too long", 7)
    assert (str(error), error.problem, error.item) == ("took too long", "took too long", 7)


@pytest.mark.parametrize("name", [name for name in errors.__all__ if name.endswith("Error")])
def test_whoever_catches_the_base_catches_all(name: str) -> None:
    assert issubclass(getattr(errors, name), EvoframeError)


def test_a_directory_that_holds_a_run_is_not_empty_either() -> None:
    """So that who asks for another directory need not know all kinds."""
    assert OccupiedError.__mro__[1:4] == (NotEmptyError, InputError, EvoframeError)
