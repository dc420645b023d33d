"""Tests of writing the output of commands."""

from __future__ import annotations

from pathlib import Path

import pytest

from evoframe import InputError
from evoframe.cli.writing import STDOUT, refuse_inputs, write_file


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


@pytest.mark.parametrize("before", [None, b"before"])
def test_a_link_is_followed_and_remains(tmp_path: Path, before: bytes | None) -> None:
    target, link = tmp_path / "target", tmp_path / "link"
    link.symlink_to(target)
    if before is not None:
        target.write_bytes(before)
        with pytest.raises(InputError):
            write_file(link, b"text", force=False)
    write_file(link, b"text", force=before is not None)
    assert link.is_symlink()
    assert target.read_bytes() == b"text"


def test_a_loop_of_links_is_named(tmp_path: Path) -> None:
    path = tmp_path / "loop"
    path.symlink_to(path)
    with pytest.raises(InputError) as caught:
        write_file(path, b"text", force=True)
    assert caught.value.source == str(path)


class TestInputs:
    @pytest.fixture
    def given(self, tmp_path: Path) -> Path:
        path = tmp_path / "given"
        path.write_bytes(b"input")
        (tmp_path / "soft").symlink_to(path)
        (tmp_path / "hard").hardlink_to(path)
        (tmp_path / "sub").mkdir()
        return path

    @pytest.mark.parametrize("name", ["given", "soft", "hard", "sub/../given", "./given"])
    @pytest.mark.parametrize("data", [b"input", b"output"])
    def test_are_never_overwritten(self, given: Path, tmp_path: Path, name: str, data: bytes) -> None:
        path = f"{tmp_path}/{name}"
        with pytest.raises(InputError) as caught:
            write_file(Path(path), data, force=True, inputs=[tmp_path / "missing", given])
        assert caught.value.source == str(Path(path))
        assert given.read_bytes() == b"input"

    def test_that_are_devices_may_be_outputs(self) -> None:
        write_file(Path("/dev/null"), b"text", force=False, inputs=[Path("/dev/null")])

    def test_need_not_exist(self, tmp_path: Path) -> None:
        refuse_inputs(tmp_path / "new", [tmp_path / "new", tmp_path / "other", Path("no\0where")])


@pytest.mark.parametrize("name", ["nowhere/file", "."])
def test_a_path_that_cannot_be_written_is_named(tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    with pytest.raises(InputError) as caught:
        write_file(path, b"text", force=True)
    assert caught.value.source == str(path)


def test_a_dash_is_standard_output(capfdbinary: pytest.CaptureFixture[bytes]) -> None:
    write_file(STDOUT, b"text", force=False)
    assert capfdbinary.readouterr().out == b"text"
