"""Files from anyone: every complaint names its file."""

from __future__ import annotations

from pathlib import Path

import pytest

from evoframe import InputError
from evoframe_simulators.files import naming

PATH = Path("some/body.vxa")


def test_what_is_wrong_begins_with_the_name() -> None:
    with pytest.raises(InputError, match=r"^some/body\.vxa: has no voxel$"), naming(PATH):
        raise InputError("has no voxel")


@pytest.mark.parametrize(
    ("error", "message"),
    [(FileNotFoundError(2, "No such file"), "No such file"), (OSError("odd"), "odd")],
)
def test_a_file_that_cannot_be_read_is_named(error: OSError, message: str) -> None:
    with pytest.raises(InputError) as caught, naming(PATH):
        raise error
    assert str(caught.value) == f"some/body.vxa: cannot be read: {message}"
    assert caught.value.__cause__ is error


def test_faults_of_the_program_are_left_alone() -> None:
    with pytest.raises(ValueError, match=r"^ours$"), naming(PATH):
        raise ValueError("ours")


def test_nothing_wrong_says_nothing() -> None:
    with naming(PATH):
        pass
