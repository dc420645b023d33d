"""Tests of reading untrusted files, and of the errors about those that are refused."""

from __future__ import annotations

import json
import os
import threading
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, strategies as st

from evoframe import ConfigurationError, InputError
from evoframe.files.reading import (
    DEEPEST,
    is_directory,
    is_file,
    is_too_deep,
    parsed_json,
    parsed_toml,
    read_text,
    refuse_links,
    shown_name,
)


class TestText:
    def test_is_read_unchanged(self, tmp_path: Path) -> None:
        path = tmp_path / "a.txt"
        path.write_bytes("größer\r\n".encode())
        assert read_text(path, 1) == "größer\r\n"

    def test_may_not_exceed_the_maximum_size(self, tmp_path: Path) -> None:
        path = tmp_path / "a.txt"
        path.write_bytes(b"x" * (1 << 20))
        assert len(read_text(path, 1)) == 1 << 20
        path.write_bytes(b"x" * ((1 << 20) + 1))
        with pytest.raises(InputError, match="1 MiB") as caught:
            read_text(path, 1)
        assert caught.value.source == str(path)

    @pytest.mark.parametrize(
        ("name", "cause"),
        [
            ("missing", "No such file"),
            (".", "Is a directory"),
            ("latin-1", "UTF-8"),
            ("no\0where", "null byte|null character"),
        ],
    )
    def test_that_cannot_be_read_is_named(self, tmp_path: Path, name: str, cause: str) -> None:
        (tmp_path / "latin-1").write_bytes("größer".encode("latin-1"))
        path = tmp_path / name
        with pytest.raises(InputError, match=cause) as caught:
            read_text(path, 1)
        assert caught.value.source == (repr(str(path)) if "\0" in name else str(path))


json_values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=3), inner, max_size=3),
    max_leaves=8,
)


@given(json_values)
def test_json_is_parsed_to_the_original_value(value: Any) -> None:
    assert parsed_json(json.dumps(value)) == value


@pytest.mark.parametrize("text", ["", "{", "[" * 50, "1" * 5000, "nope"])
def test_invalid_json_is_a_value_error(text: str) -> None:
    with pytest.raises(ValueError, match="JSON"):
        parsed_json(text)


def test_toml_is_parsed_to_tables() -> None:
    assert parsed_toml('[a]\nb = [1, 2.5]\nc.d = "x"', "here") == {"a": {"b": [1, 2.5], "c": {"d": "x"}}}


@pytest.mark.parametrize("text", ["a", "a = ", "a = " + "1" * 5000, "a = " + "[" * 50])
@pytest.mark.parametrize("error", [InputError, ConfigurationError])
def test_invalid_toml_is_an_error_of_the_given_type(text: str, error: type[InputError]) -> None:
    with pytest.raises(error, match="TOML") as caught:
        parsed_toml(text, "my.toml", error)
    assert caught.value.source == "my.toml"


class TestKinds:
    def test_files_and_directories_are_distinguished(self, tmp_path: Path) -> None:
        path = tmp_path / "file"
        path.touch()
        assert (is_file(path), is_directory(path)) == (True, False)
        assert (is_file(tmp_path), is_directory(tmp_path)) == (False, True)

    def test_a_missing_path_is_not_a_file_and_raises_as_a_directory(self, tmp_path: Path) -> None:
        (tmp_path / "file").touch()
        for path in (tmp_path / "missing", tmp_path / "file" / "below"):
            assert not is_file(path)
            with pytest.raises(InputError) as caught:
                is_directory(path)
            assert caught.value.source == str(path)

    @pytest.mark.parametrize("name", ["no\0where", "n" * 5000])
    def test_an_impossible_name_raises_in_both(self, tmp_path: Path, name: str) -> None:
        for test in (is_file, is_directory):
            with pytest.raises(InputError) as caught:
                test(tmp_path / name)
            assert repr(name)[1:-1] in caught.value.source


def test_a_shown_name_can_be_encoded(tmp_path: Path) -> None:
    path = tmp_path / os.fsdecode(b"caf\xe9")  # a name that is not UTF-8
    path.mkdir()
    assert shown_name(path) == "caf?"
    assert shown_name(tmp_path / "x" / "..") == tmp_path.name


class TestLinks:
    def test_are_refused_wherever_they_point(self, tmp_path: Path) -> None:
        (tmp_path / "there").touch()
        here = tmp_path / "here"
        here.mkdir()
        (here / "config.toml").symlink_to(tmp_path / "there")
        with pytest.raises(InputError, match="a link") as caught:
            refuse_links(here)
        assert caught.value.source == str(here / "config.toml")

    def test_a_pipe_is_refused(self, tmp_path: Path) -> None:
        os.mkfifo(tmp_path / "run.db")
        with pytest.raises(InputError, match="regular file") as caught:
            refuse_links(tmp_path)
        assert caught.value.source == str(tmp_path / "run.db")

    def test_files_and_directories_are_accepted(self, tmp_path: Path) -> None:
        (tmp_path / "file").touch()
        (tmp_path / "folder").mkdir()
        refuse_links(tmp_path)
        refuse_links(tmp_path / "missing")  # reported by the caller

    def test_a_file_instead_of_the_directory_is_refused(self, tmp_path: Path) -> None:
        (tmp_path / "file").touch()
        with pytest.raises(InputError, match="Not a directory") as caught:
            refuse_links(tmp_path / "file")
        assert caught.value.source == str(tmp_path / "file")


WINDOWS = Path(__file__).parents[1] / "data" / "windows"

OTHER_ENCODINGS = [
    *[("utf-16", "UTF-16"), ("utf-16-le", "UTF-16"), ("utf-16-be", "UTF-16")],
    *[("utf-32", "UTF-32"), ("utf-32-le", "UTF-32"), ("utf-32-be", "UTF-32")],
]


class TestTextOfWindows:
    def test_begins_with_a_mark_that_is_not_part_of_the_text(self, tmp_path: Path) -> None:
        path = tmp_path / "a.txt"
        path.write_text("größer\r\n", encoding="utf-8-sig", newline="")
        assert read_text(path, 1) == "größer\r\n"
        assert parsed_toml(read_text(WINDOWS / "bom.toml", 1), "bom.toml") == {"extends": "quick"}

    @pytest.mark.parametrize(("encoding", "name"), OTHER_ENCODINGS)
    @pytest.mark.parametrize("mark", ["", "\ufeff"])
    @pytest.mark.parametrize("text", ['extends = "quick"\r\n', '{"a": 1}', "a,b\n1,2\n", "#größer\n"])
    def test_in_another_encoding_is_refused_with_its_name(
        self, tmp_path: Path, encoding: str, name: str, mark: str, text: str
    ) -> None:
        path = tmp_path / "a.txt"
        path.write_bytes((mark + text).encode(encoding))
        with pytest.raises(InputError, match=f"{name}.*UTF-8") as caught:
            read_text(path, 1)
        assert caught.value.source == str(path)

    @given(text=st.text(st.characters(exclude_categories=["Cs"], exclude_characters="\ufeff\0")))
    def test_in_utf_8_is_never_mistaken_for_another_encoding(
        self, tmp_path_factory: pytest.TempPathFactory, text: str
    ) -> None:
        path = tmp_path_factory.getbasetemp() / "text.txt"
        for encoding in ("utf-8", "utf-8-sig"):
            path.write_bytes(text.encode(encoding))
            assert read_text(path, 1) == text


@given(json_values, st.sampled_from(["\n", "\r\n", "\r"]))
def test_line_ends_in_json_do_not_matter(value: Any, end: str) -> None:
    assert parsed_json(json.dumps(value, indent=1).replace("\n", end)) == value


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_line_ends_in_toml_do_not_matter(end: str) -> None:
    text = '# comment\n[a]\nb = [\n1,\n2.5]\n\nc.d = """x\ny"""\n'
    tables = {"a": {"b": [1, 2.5], "c": {"d": "x\ny"}}}
    assert parsed_toml(text.replace("\n", end), "here") == tables


def lists(depth: int) -> str:
    return "[" * depth + "]" * depth


class TestDepth:
    @pytest.mark.parametrize("depth", [2, DEEPEST - 1, DEEPEST, DEEPEST + 1, 900, 100_000])
    def test_is_limited_in_json(self, depth: int) -> None:
        for text in (lists(depth), '{"a":' * depth + "0" + "}" * depth, f"[1, {lists(depth - 1)}, 2]"):
            if depth <= DEEPEST:
                parsed_json(text)
            else:
                with pytest.raises(ValueError, match=f"{DEEPEST} deep"):
                    parsed_json(text)

    @pytest.mark.parametrize("depth", [2, DEEPEST - 1, DEEPEST, DEEPEST + 1, 900, 100_000])
    def test_is_limited_in_toml(self, depth: int) -> None:
        dotted, header = ".".join(["'a'"] * depth), " . ".join(["a"] * (depth - 1))
        inline = "{a=" * (depth - 1) + "1" + "}" * (depth - 1)
        for text in (f"a = {lists(depth - 1)}", f"{dotted} = 1", f"[{header}]", f"a = {inline}"):
            if depth <= DEEPEST:
                parsed_toml(text, "here")
            else:
                with pytest.raises(InputError, match=f"{DEEPEST} deep") as caught:
                    parsed_toml(text, "here")
                assert caught.value.source == "here"

    def test_of_a_document_that_contains_itself_is_not_finite(self) -> None:
        cyclic: list[Any] = []
        cyclic += [(cyclic,), cyclic, cyclic]
        assert is_too_deep({"a": cyclic})
        assert not is_too_deep("text")


def test_half_a_character_is_refused() -> None:
    half = "\ud800"
    for text in ('{"a": "\\uD800"}', '["\\udfff"]'):
        with pytest.raises(ValueError, match="JSON"):
            parsed_json(text)
    assert parsed_json('"\\ud83e\\udd16"') == "\N{ROBOT FACE}"
    with pytest.raises(InputError, match="TOML") as caught:
        parsed_toml(f"a = '{half}'", "--set a")
    assert caught.value.source == "--set a"


def test_a_pipe_that_nothing_writes_to_is_refused_at_once(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(InputError, match="is a pipe, and nothing was written to it") as caught:
        read_text(tmp_path / "pipe", 1)
    assert caught.value.source == str(tmp_path / "pipe")


def test_a_pipe_is_read_to_its_end() -> None:
    reader, writer = os.pipe()

    def write() -> None:
        with os.fdopen(writer, "w") as file:
            file.write("a" * 200_000)  # more than a pipe holds

    thread = threading.Thread(target=write)
    thread.start()
    try:
        assert read_text(Path(f"/dev/fd/{reader}"), 1) == "a" * 200_000
    finally:
        os.close(reader)
        thread.join()
