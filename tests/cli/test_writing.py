"""Tests of writing the output of commands."""

from __future__ import annotations

from pathlib import Path

import pytest

from evoframe import InputError
from evoframe.cli.writing import STDOUT, write_file


def test_writes_a_file_and_the_same_again(tmp_path: Path) -> None:
    path = tmp_path / "file"
    for _ in range(2):
        write_file(path, b"text", force=False)
        assert path.read_bytes() == b"text"


def test_different_content_is_overwritten_only_with_force(tmp_path: Path) -> None:
    path = tmp_path / "file"
    path.write_bytes(b"before")
    with pytest.raises(InputError) as caught:
        write_file(path, b"after", force=False)
    assert caught.value.source == str(path)
    assert path.read_bytes() == b"before"
    write_file(path, b"after", force=True)
    assert path.read_bytes() == b"after"


@pytest.mark.parametrize("name", ["nowhere/file", "."])
def test_a_path_that_cannot_be_written_is_named(tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    with pytest.raises(InputError) as caught:
        write_file(path, b"text", force=True)
    assert caught.value.source == str(path)


def test_a_dash_is_standard_output(capfdbinary: pytest.CaptureFixture[bytes]) -> None:
    write_file(STDOUT, b"text", force=False)
    assert capfdbinary.readouterr().out == b"text"
