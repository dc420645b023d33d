"""Whose fault it is: what a component raises is its own, and what is meant for a person passes."""

from __future__ import annotations

import pytest

from evoframe import InputError
from evoframe.contract.blame import blaming
from evoframe.errors import ComponentError


@pytest.mark.parametrize("error", [ZeroDivisionError("oops"), KeyError("oops"), SystemExit("oops")])
def test_what_a_component_raises_is_reported_as_its_own(error: BaseException) -> None:
    with pytest.raises(ComponentError) as caught, blaming("aggregator", "a 1"):
        raise error
    assert (caught.value.component, caught.value.concerns) == ("aggregator", "a 1")
    assert caught.value.problem == f"{type(error).__name__}: {error}"
    assert caught.value.__cause__ is error


def test_an_error_for_a_person_passes_as_it_is() -> None:
    error = InputError("has no voxel")
    with pytest.raises(InputError) as caught, blaming("simulator"):
        raise error
    assert caught.value is error


def test_blame_falls_on_the_innermost_component() -> None:
    with pytest.raises(ComponentError, match=r"^objective: ZeroDivisionError"), blaming("executor"):  # noqa: SIM117
        with blaming("objective"):
            raise ZeroDivisionError


def test_ctrl_c_is_nobodys_fault() -> None:
    with pytest.raises(KeyboardInterrupt), blaming("simulator"):
        raise KeyboardInterrupt


def test_where_nothing_fails_nothing_happens() -> None:
    with blaming("simulator"):
        result = 1
    assert result == 1
