"""VXA, VXC and VXD files as documents with the sections of a VXA file."""

from __future__ import annotations

from pathlib import Path

import pytest
from lxml import etree

from evoframe import ConfigurationError, InputError
from evoframe_simulators.vox.vxa.assembling import read_document

BASE = "<VXA><Simulator><A>1</A></Simulator><VXC><Structure><B>2</B></Structure><Palette/></VXC></VXA>"


def write(path: Path, text: str) -> Path:
    path.write_text(text)
    return path


def text_of(path: Path, base: Path | None = None) -> str:
    return etree.tostring(read_document(path, base).root.element).decode()


@pytest.fixture
def base(tmp_path: Path) -> Path:
    return write(tmp_path / "base.vxa", BASE)


def test_a_vxa_file_is_complete(base: Path) -> None:
    document = read_document(base)
    assert (document.complete, document.base, text_of(base)) == (True, None, BASE)


def test_a_vxa_file_has_no_base(base: Path) -> None:
    with pytest.raises(ConfigurationError) as caught:
        read_document(base, base)
    assert caught.value.source == "--base"


def test_a_vxc_file_is_a_body_alone_or_replaces_that_of_a_base(base: Path, tmp_path: Path) -> None:
    path = write(tmp_path / "a.vxc", "<VXC><C/></VXC>")
    document = read_document(path)
    assert (document.complete, text_of(path)) == (False, "<VXA><VXC><C/></VXC></VXA>")
    assert read_document(path, base).complete
    assert text_of(path, base) == "<VXA><Simulator><A>1</A></Simulator><VXC><C/></VXC></VXA>"


@pytest.mark.parametrize(
    ("parts", "expected"),
    [
        (
            '<Structure replace="VXA.VXC.Structure" Compression="BASE64"><D/></Structure>',
            BASE.replace(
                "<Structure><B>2</B></Structure>", '<Structure Compression="BASE64"><D/></Structure>'
            ),
        ),
        ('<A replace="VXA.Simulator.A">3</A><Note>4</Note>', BASE.replace("<A>1</A>", "<A>3</A>")),
        (
            '<E replace="VXA.Environment.Gravity.GravAcc">5</E>',
            BASE.replace(
                "</VXA>", "<Environment><Gravity><GravAcc>5</GravAcc></Gravity></Environment></VXA>"
            ),
        ),
    ],
)
def test_sections_of_a_vxd_file_replace_those_of_its_base(
    parts: str, expected: str, base: Path, tmp_path: Path
) -> None:
    path = write(tmp_path / "a.vxd", f"<VXD>{parts}</VXD>")
    assert text_of(path) == text_of(path, base) == expected
    assert read_document(path).base == base


@pytest.mark.parametrize(
    "parts",
    [
        "",
        "<Structure/>",
        '<A replace=""/>',
        '<A replace="VXA"/>',
        '<A replace="VXC.Structure"/>',
        '<A replace="VXA..B"/>',
        '<A replace="VXA.*"/>',
        f'<A replace="VXA{".B" * 9}"/>',
        '<A replace="VXA.B"/>' * 101,
    ],
)
def test_other_vxd_files_are_rejected(parts: str, base: Path, tmp_path: Path) -> None:
    path = write(tmp_path / "a.vxd", f"<VXD>{parts}</VXD>")
    with pytest.raises(InputError) as caught:
        read_document(path, base)
    assert caught.value.source == str(path)
    assert caught.value.key.startswith("VXD")


@pytest.mark.parametrize("text", ["<VXC/>", "<VXD/>", "<a/>", "no XML"])
def test_a_base_is_a_vxa_file(text: str, tmp_path: Path) -> None:
    base = write(tmp_path / "base.vxa", text)
    path = write(tmp_path / "a.vxd", '<VXD><A replace="VXA.A"/></VXD>')
    with pytest.raises(InputError) as caught:
        read_document(path)
    assert caught.value.source == str(base)


def test_a_missing_base_is_named(tmp_path: Path) -> None:
    path = write(tmp_path / "a.vxd", '<VXD><A replace="VXA.A"/></VXD>')
    with pytest.raises(InputError) as caught:
        read_document(path, tmp_path / "none.vxa")
    assert caught.value.source == str(tmp_path / "none.vxa")


def test_the_root_tag_tells_the_kind_of_file(tmp_path: Path) -> None:
    path = write(tmp_path / "a.vxa", "<VXC/>")
    assert not read_document(path).complete
    with pytest.raises(InputError, match=r"'html'.* VXA, VXC .* VXD"):
        read_document(write(tmp_path / "b.vxa", "<html/>"))
