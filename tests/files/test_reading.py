"""Files from anyone: what is read, and what is refused in a sentence."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, strategies as st

from evoframe import ConfigurationError, InputError
from evoframe.files.reading import (
    is_directory,
    is_file,
    parsed_json,
    parsed_toml,
    read_text,
    refuse_links,
    shown_name,
)


class TestText:
    def test_is_that_of_the_file(self, tmp_path: Path) -> None:
        path = tmp_path / "a.txt"
        path.write_bytes("größer\r\n".encode())
        assert read_text(path, 1) == "größer\r\n"

    def test_may_be_as_large_as_is_said_and_no_larger(self, tmp_path: Path) -> None:
        path = tmp_path / "a.txt"
        path.write_bytes(b"x" * (1 << 20))
        assert len(read_text(path, 1)) == 1 << 20
        path.write_bytes(b"x" * ((1 << 20) + 1))
        with pytest.raises(InputError, match=r"a\.txt: .* 1 MiB"):
            read_text(path, 1)

    @pytest.mark.parametrize(
        ("name", "message"),
        [
            ("missing", "missing: cannot be read: No such file"),
            (".", "cannot be read: Is a directory"),
            ("latin-1", "latin-1: is not UTF-8 text"),
            ("no\0where", r"no\\x00where'?: cannot be read"),
        ],
    )
    def test_that_cannot_be_read_is_named(self, tmp_path: Path, name: str, message: str) -> None:
        (tmp_path / "latin-1").write_bytes("größer".encode("latin-1"))
        with pytest.raises(InputError, match=message):
            read_text(tmp_path / name, 1)


json_values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=3), inner, max_size=3),
    max_leaves=8,
)


@given(json_values)
def test_json_is_what_was_dumped(value: Any) -> None:
    assert parsed_json(json.dumps(value)) == value


@pytest.mark.parametrize("text", ["", "{", "[" * 100_000, "1" * 5000, "nope"])
def test_what_is_no_json_is_one_kind_of_error(text: str) -> None:
    with pytest.raises(ValueError, match=r"^not valid JSON: "):
        parsed_json(text)


def test_toml_is_tables() -> None:
    assert parsed_toml('[a]\nb = [1, 2.5]\nc.d = "x"', "here") == {"a": {"b": [1, 2.5], "c": {"d": "x"}}}


@pytest.mark.parametrize("text", ["a", "a = ", "a = " + "1" * 5000, "a = " + "[" * 100_000])
@pytest.mark.parametrize("error", [InputError, ConfigurationError])
def test_what_is_no_toml_is_named_as_the_error_that_was_asked_for(text: str, error: type[InputError]) -> None:
    with pytest.raises(error, match=r"^my\.toml: not valid TOML: "):
        parsed_toml(text, "my.toml", error)


class TestKinds:
    def test_are_told_apart(self, tmp_path: Path) -> None:
        path = tmp_path / "file"
        path.touch()
        assert (is_file(path), is_directory(path)) == (True, False)
        assert (is_file(tmp_path), is_directory(tmp_path)) == (False, True)

    def test_nothing_is_no_file_but_an_error_where_a_directory_is_needed(self, tmp_path: Path) -> None:
        (tmp_path / "file").touch()
        for path in (tmp_path / "missing", tmp_path / "file" / "below"):
            assert not is_file(path)
            with pytest.raises(InputError, match="cannot be read: "):
                is_directory(path)

    @pytest.mark.parametrize("name", ["no\0where", "n" * 5000])
    def test_a_name_that_no_file_can_have_is_an_error_of_both(self, tmp_path: Path, name: str) -> None:
        for look in (is_file, is_directory):
            with pytest.raises(InputError, match="cannot be read: "):
                look(tmp_path / name)


def test_a_name_is_shown_as_text_that_can_be_written(tmp_path: Path) -> None:
    path = tmp_path / os.fsdecode(b"caf\xe9")  # a name that is no UTF-8
    path.mkdir()
    assert shown_name(path) == "caf?"
    assert shown_name(tmp_path / "x" / "..") == tmp_path.name


class TestLinks:
    def test_are_refused_wherever_they_lead(self, tmp_path: Path) -> None:
        (tmp_path / "there").touch()
        here = tmp_path / "here"
        here.mkdir()
        (here / "config.toml").symlink_to(tmp_path / "there")
        with pytest.raises(InputError, match=r"config\.toml: is a link; a run's directory"):
            refuse_links(here)

    def test_and_what_would_wait_forever_is_refused(self, tmp_path: Path) -> None:
        os.mkfifo(tmp_path / "run.db")
        with pytest.raises(InputError, match=r"run\.db: is no file"):
            refuse_links(tmp_path)

    def test_files_and_directories_are_welcome(self, tmp_path: Path) -> None:
        (tmp_path / "file").touch()
        (tmp_path / "folder").mkdir()
        refuse_links(tmp_path)
        refuse_links(tmp_path / "missing")  # of which whoever reads it says so

    def test_what_is_no_directory_is_refused(self, tmp_path: Path) -> None:
        (tmp_path / "file").touch()
        with pytest.raises(InputError, match="file: cannot be read: Not a directory"):
            refuse_links(tmp_path / "file")
