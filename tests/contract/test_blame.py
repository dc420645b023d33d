"""Tests of blaming: exceptions of components are wrapped, and errors of evoframe are not."""

from __future__ import annotations

import pytest

from evoframe import InputError
from evoframe.contract.blame import blaming
from evoframe.errors import ComponentError


@pytest.mark.parametrize("error", [ZeroDivisionError("oops"), KeyError("oops"), SystemExit("oops")])
def test_an_exception_is_attributed_to_its_component(error: BaseException) -> None:
    with pytest.raises(ComponentError) as caught, blaming("aggregator", "a 1"):
        raise error
    assert (caught.value.component, caught.value.concerns) == ("aggregator", "a 1")
    assert caught.value.problem == f"{type(error).__name__}: {error}"
    assert caught.value.__cause__ is error


def test_an_error_of_evoframe_is_not_wrapped() -> None:
    error = InputError("has no voxel")
    with pytest.raises(InputError) as caught, blaming("simulator"):
        raise error
    assert caught.value is error


def test_blame_falls_on_the_innermost_component() -> None:
    with pytest.raises(ComponentError, match="ZeroDivisionError") as caught, blaming("executor"):  # noqa: SIM117
        with blaming("objective"):
            raise ZeroDivisionError
    assert caught.value.component == "objective"


def test_ctrl_c_is_not_attributed_to_a_component() -> None:
    with pytest.raises(KeyboardInterrupt), blaming("simulator"):
        raise KeyboardInterrupt


def test_a_block_without_an_error_is_not_affected() -> None:
    with blaming("simulator"):
        result = 1
    assert result == 1
