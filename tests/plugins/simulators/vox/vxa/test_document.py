"""Parsing of untrusted XML with limits."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given, strategies as st

from evoframe import InputError
from evoframe_simulators.vox.vxa import document
from evoframe_simulators.vox.vxa.document import parse_xml, shorten


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "a.vxa"


@pytest.mark.parametrize("encoding", ["utf-8", "iso-8859-1"])
def test_the_declared_encoding_is_ignored(path: Path, encoding: str) -> None:
    path.write_bytes('<?xml version="1.0" encoding="utf-16"?><A>é</A>'.encode(encoding))
    assert parse_xml(path).text == "é"


TEXT = '<?xml version="1.0" encoding="{}"?><A>é</A>'


@pytest.mark.parametrize("declared", ["UTF-16", "utf-16", "UTF-16LE", ""])
@pytest.mark.parametrize("encoding", ["utf-16-le", "utf-16-be"])
@pytest.mark.parametrize("mark", ["\ufeff", ""])
def test_utf_16_is_read_if_the_file_declares_it(path: Path, declared: str, encoding: str, mark: str) -> None:
    text = TEXT.format(declared) if declared else "<A>é</A>"
    path.write_bytes((mark + text).encode(encoding))
    if mark or declared:
        assert parse_xml(path).text == "é"
    else:
        with pytest.raises(InputError, match="UTF-16"):
            parse_xml(path)


@pytest.mark.parametrize("declared", ["ISO-8859-1", "utf-8", "windows-1252"])
@pytest.mark.parametrize("mark", ["\ufeff", ""])
def test_utf_16_that_declares_another_encoding_is_rejected_with_both_names(
    path: Path, declared: str, mark: str
) -> None:
    path.write_bytes((mark + TEXT.format(declared)).encode("utf-16-le"))
    with pytest.raises(InputError, match=f"UTF-16, but declares {declared}"):
        parse_xml(path)


@pytest.mark.parametrize("encoding", ["utf-32", "utf-32-le", "utf-32-be"])
def test_utf_32_is_rejected_with_its_name(path: Path, encoding: str) -> None:
    path.write_bytes(TEXT.format("utf-32").encode(encoding))
    with pytest.raises(InputError, match="UTF-32"):
        parse_xml(path)


def test_damaged_utf_16_is_rejected_with_its_name(path: Path) -> None:
    path.write_bytes(TEXT.format("utf-16").encode("utf-16")[:-1])
    with pytest.raises(InputError, match="UTF-16"):
        parse_xml(path)


def test_entities_in_utf_16_are_rejected(path: Path) -> None:
    path.write_bytes('<!DOCTYPE A [<!ENTITY a "b">]><A>&a;</A>'.encode("utf-16"))
    with pytest.raises(InputError, match="DOCTYPE"):
        parse_xml(path)


def test_comments_and_instructions_are_removed(path: Path) -> None:
    path.write_text("<A><!-- 1 --><?b 2?><C/></A>")
    assert [child.tag for child in parse_xml(path)] == ["C"]


@pytest.mark.parametrize("text", ["<A b='1'/>" * 3, "<A><B></B><C/></A>", "<A b=\"1\" c='2' d=''/>"])
def test_the_number_of_elements_and_attributes_is_limited(
    path: Path, text: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    path.write_text(f"<R>{text}</R>")
    most = max(text.count("</") + text.count("/>") + 1, (text.count("'") + text.count('"')) // 2)
    monkeypatch.setattr(document, "_MOST_ELEMENTS", most)
    assert parse_xml(path).tag == "R"
    monkeypatch.setattr(document, "_MOST_ELEMENTS", most - 1)
    with pytest.raises(InputError, match=f" {most - 1} elements"):
        parse_xml(path)


def test_the_size_is_limited(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(document, "_MOST_BYTES", 2**20)
    path.write_bytes(b"<A/>".ljust(2**20))
    assert parse_xml(path).tag == "A"
    path.write_bytes(b"<A/>".ljust(2**20 + 1))
    with pytest.raises(InputError, match=r" 1 MiB$"):
        parse_xml(path)


@given(text=st.text(), quoted=st.booleans())
def test_a_shown_text_is_one_short_printable_line(text: str, quoted: bool) -> None:
    line = shorten(text, quoted=quoted)
    assert line.isprintable()
    assert len(line) <= 2 * 60 + 3
    assert line.startswith("'") or not quoted


def test_a_long_text_is_shown_with_dots() -> None:
    assert shorten("a" * 61) == f"'{'a' * 60}...'"
    assert shorten("a\n b\x07") == "'a b?'"
