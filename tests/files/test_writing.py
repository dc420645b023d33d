"""Tests of writing: readers see either the old or the new content, and JSON has one form."""

from __future__ import annotations

import errno
import os
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, strategies as st

from evoframe import RunError
from evoframe.files.reading import parsed_json, read_text
from evoframe.files.writing import is_leftover, json_text, remove, write_atomically, write_json

json_values = st.recursive(
    st.none()
    | st.booleans()
    | st.integers()
    | st.floats(allow_nan=False, allow_infinity=False)
    | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=3), inner, max_size=3),
    max_leaves=8,
)


def test_a_link_in_place_of_the_temporary_file_is_not_followed(tmp_path: Path) -> None:
    (tmp_path / "mine").write_text("before")
    (tmp_path / ".file.new").symlink_to(tmp_path / "mine")
    write_atomically(tmp_path / "file", b"after")
    assert (tmp_path / "mine").read_text() == "before"
    assert (tmp_path / "file").read_bytes() == b"after"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["file", "mine"]


@given(document=json_values)
def test_json_is_read_back_as_it_was_written(tmp_path_factory: pytest.TempPathFactory, document: Any) -> None:
    path = tmp_path_factory.getbasetemp() / "document.json"
    write_json(path, document)
    again = parsed_json(read_text(path, 1))
    assert again == document
    assert json_text(again) == json_text(document) == path.read_text().removesuffix("\n")


def cyclic() -> list[Any]:
    values: list[Any] = []
    values.append(values)
    return values


@pytest.mark.parametrize(
    ("document", "error"),
    [
        ({1, 2}, TypeError),
        (float("nan"), ValueError),
        ([float("inf")], ValueError),
        (cyclic(), ValueError),
    ],
    ids=["set", "nan", "inf", "cyclic"],
)
def test_an_invalid_document_leaves_the_file_unchanged(
    tmp_path: Path, document: Any, error: type[Exception]
) -> None:
    path = tmp_path / "document.json"
    write_json(path, {"old": 1})
    with pytest.raises(error):
        write_json(path, document)
    assert [each.name for each in tmp_path.iterdir()] == ["document.json"]
    assert path.read_text() == '{"old":1}\n'


class TestAtomically:
    def test_the_old_file_remains_until_the_new_one_is_on_the_disk(
        self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        path = tmp_path / "file"
        path.write_bytes(b"old")
        seen: list[Any] = []

        def look(descriptor: int) -> None:
            [new] = [each for each in tmp_path.iterdir() if is_leftover(each)]
            seen.append((path.read_bytes(), new.read_bytes()))

        monkeypatch.setattr(os, "fsync", look)
        write_atomically(path, b"new")
        assert seen == [(b"old", b"new")]
        assert (path.read_bytes(), len(list(tmp_path.iterdir()))) == (b"new", 1)

    def test_a_full_disk_leaves_only_the_old_file(
        self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        def full(descriptor: int) -> None:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

        path = tmp_path / "file"
        path.write_bytes(b"old")
        monkeypatch.setattr(os, "fsync", full)
        with pytest.raises(RunError, match="No space") as caught:
            write_atomically(path, b"new")
        assert caught.value.source == str(path)
        assert (path.read_bytes(), len(list(tmp_path.iterdir()))) == (b"old", 1)

    def test_a_missing_directory_is_not_created(self, tmp_path: Path) -> None:
        path = tmp_path / "missing" / "file"
        with pytest.raises(RunError, match="No such file") as caught:
            write_atomically(path, b"new")
        assert caught.value.source == str(path)
        assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("name", "left"),
    [(".run.db.new", True), ("run.db.new", False), (".run.db", False), ("run.db", False)],
)
def test_a_temporary_file_is_recognized_by_its_name(name: str, left: bool) -> None:
    assert is_leftover(Path("somewhere") / name) == left


class TestRemoving:
    def test_a_missing_file_is_not_an_error(self, tmp_path: Path) -> None:
        path = tmp_path / "file"
        path.touch()
        remove(path)
        remove(path)
        assert not path.exists()

    def test_a_directory_is_an_error(self, tmp_path: Path) -> None:
        (tmp_path / "folder").mkdir()
        with pytest.raises(RunError) as caught:
            remove(tmp_path / "folder")
        assert caught.value.source == str(tmp_path / "folder")
