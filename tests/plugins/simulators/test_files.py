"""Errors in files given by the user, with the name of the file."""

from __future__ import annotations

from pathlib import Path

import pytest

from evoframe import InputError
from evoframe_simulators.files import naming_source

PATH = Path("some/body.vxa")


def test_an_error_gets_the_file_as_its_source() -> None:
    with pytest.raises(InputError) as caught, naming_source(PATH):
        raise InputError("has no voxels", key="VXC/Structure")
    assert caught.value.source == str(PATH)
    assert caught.value.key == "VXC/Structure"
    assert caught.value.problem == "has no voxels"


@pytest.mark.parametrize(
    ("error", "message"),
    [(FileNotFoundError(2, "No such file"), "No such file"), (OSError("odd"), "odd")],
)
def test_a_file_that_cannot_be_read_is_named(error: OSError, message: str) -> None:
    with pytest.raises(InputError) as caught, naming_source(PATH):
        raise error
    assert caught.value.source == str(PATH)
    assert caught.value.problem.endswith(f": {message}")
    assert caught.value.__cause__ is error


def test_other_exceptions_are_not_changed() -> None:
    with pytest.raises(ValueError, match=r"^internal$"), naming_source(PATH):
        raise ValueError("internal")


def test_a_block_without_errors_raises_nothing() -> None:
    with naming_source(PATH):
        pass
