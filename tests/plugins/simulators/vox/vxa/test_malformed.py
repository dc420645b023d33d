"""Rejection of over two hundred malformed files, quickly and in little memory."""

from __future__ import annotations

import codecs
import itertools
import re
import zlib
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from processes import python

from evoframe import ConfigurationError, EvoframeError, InputError
from evoframe_simulators import Vox

TEMPLATE = (Path(__file__).parents[4] / "data" / "vxa" / "template.vxa").read_text(encoding="utf-8")
HEAD = TEMPLATE.splitlines()[0]

NUMBERS = (
    *("Lattice_Dim", "DtFrac", "BondDampingZ", "ColDampingZ", "SlowDampingZ", "CollisionHorizon"),
    *("StopConditionValue", "InitCmTime", "TempAmp", "TempBase", "TempPeriod"),
    *("Elastic_Mod", "Density", "Poissons_Ratio", "CTE", "uStatic", "X", "dX"),
)
WHOLE = ("SelfColEnabled", "ColSystem", "StopConditionType", "GravEnabled", "FloorEnabled", "TempEnabled")
NEEDED = (
    *(
        "Simulator",
        "Damping",
        "StopCondition",
        "Environment",
        "Gravity",
        "Thermal",
        "VXC",
        "Lattice",
        "Palette",
    ),
    *("Structure", "Data", "X_Voxels", "Y_Voxels", "Z_Voxels", "Mechanical", "Elastic_Mod", "Density"),
    "StopConditionValue",
)
OUT_OF_RANGE = (
    *(("Lattice_Dim", "-0.05"), ("Lattice_Dim", "0"), ("Lattice_Dim", "1e9"), ("Lattice_Dim", "1e-9")),
    *(("DtFrac", "0"), ("DtFrac", "1.5"), ("SlowDampingZ", "-1"), ("CollisionHorizon", "0")),
    *(("CollisionHorizon", "11"), ("StopConditionValue", "0"), ("StopConditionValue", "1e300")),
    *(("StopConditionValue", "1e9"), ("InitCmTime", "-1"), ("TempPeriod", "0"), ("TempPeriod", "1e-300")),
    *(("TempAmp", "1e300"), ("Elastic_Mod", "0"), ("Elastic_Mod", "1e300"), ("Density", "-1e6")),
    *(("Density", "1e-300"), ("Poissons_Ratio", "0.6"), ("Poissons_Ratio", "-1"), ("uDynamic", "-0.5")),
    *(("CTE", "1e308"), ("dX", "-0.01"), ("dZ", "-1"), ("DofFixed", "64"), ("DofFixed", "-1")),
    *(("DofFixed", "1.5"), ("PrimType", "9"), ("NumBCs", "0"), ("NumBCs", "2"), ("NumBCs", "-1")),
    *(("NumBCs", "1e9"), ("SelfColEnabled", "2"), ("ColSystem", "4"), ("StopConditionType", "7")),
    *(("X_Voxels", "0"), ("X_Voxels", "-6"), ("X_Voxels", "5"), ("X_Voxels", "6.5"), ("X_Voxels", "1e300")),
    *(("Y_Voxels", "4"), ("Y_Voxels", "nan"), ("Z_Voxels", "2"), ("Z_Voxels", "4"), ("Z_Voxels", "9" * 5000)),
)
CELLS = (
    "5",
    "9",
    "~",
    "/",
    " ",
    "-",
    "\x7f",
    "é",
    "\N{ARABIC-INDIC DIGIT THREE}",
    "\N{GRINNING FACE}",
    "",
    "11",
)
OFFSETS = (
    *("nan", "inf", "-inf", "1e999", "1e7", "-1e300", "", "zero", "0x1p3", "1_0", "1 2", "1;2", "1,2", "--1"),
    *("\N{ARABIC-INDIC DIGIT THREE}", "1e", ".", "+", "<b/>"),
)
ENCODINGS = ("utf-16", "utf-32", "utf-16-be", "cp500", "utf-32-be")
NO_VXA = (
    *("", " \n", "VXA", "{}", "<VXA/>", "<VXA></VXA>", "<VXA>", "</VXA>", "<VXC/>", "<html><body/></html>"),
    *("<vxa/>", "<VXA/><VXA/>", "<VXA a='1' a='2'/>", "<VXA a=1/>", "<VXA><Simulator></VXA></Simulator>"),
    *("<VXA xmlns='urn:x'><Simulator/></VXA>", "<VXA>&unknown;</VXA>", "<VXA>&#0;</VXA>", "<VXA>\x01</VXA>"),
    *("<VXA><!-- </VXA>", "<VXA><![CDATA[ </VXA>", "<VXA><?pi </VXA>", "<?xml version='9'?><VXA/>"),
)

DOCTYPES = {
    "billion laughs": (
        "<!DOCTYPE VXA [<!ENTITY a0 'ha'>"
        + "".join(f"<!ENTITY a{n} '{f'&a{n - 1};' * 10}'>" for n in range(1, 10))
        + "]>",
        "&a9;",
    ),
    "quadratic blowup": (f"<!DOCTYPE VXA [<!ENTITY a '{'a' * 50_000}'>]>", "&a;" * 50_000),
    "external entity": ("<!DOCTYPE VXA [<!ENTITY a SYSTEM 'file:///etc/passwd'>]>", "&a;"),
    "entity of a network": ("<!DOCTYPE VXA [<!ENTITY a SYSTEM 'http://localhost:9/a'>]>", "&a;"),
    "parameter entity": ("<!DOCTYPE VXA [<!ENTITY % a SYSTEM 'file:///etc/passwd'> %a;]>", ""),
    "external subset": ("<!DOCTYPE VXA SYSTEM 'file:///dev/zero'>", ""),
    "plain doctype": ("<!DOCTYPE VXA>", ""),
    "entity alone": ("<!ENTITY a 'a'>", ""),
}


def replaced(tag: str, text: str) -> str:
    """Return the template with another text in the first element *tag*."""
    changed, found = re.subn(rf"<{tag}>[^<]*</{tag}>", lambda _: f"<{tag}>{text}</{tag}>", TEMPLATE, count=1)
    assert found
    return changed


def without(tag: str) -> str:
    return re.sub(rf"<{tag}[ >].*?</{tag}>", "", TEMPLATE, count=1, flags=re.DOTALL)


def twice(tag: str) -> str:
    return re.sub(rf"<{tag}[ >].*?</{tag}>", lambda m: m[0] * 2, TEMPLATE, count=1, flags=re.DOTALL)


def wrong_values() -> Iterator[tuple[str, str]]:
    """Yield a description and the text of files with one invalid value."""
    for tag in NUMBERS:
        for text in ("nan", "-inf", "1e999", "", "five"):
            yield f"{tag} {text or 'empty'}", replaced(tag, text)
    for tag in WHOLE:
        yield f"{tag} half", replaced(tag, "0.5")
    for tag, text in OUT_OF_RANGE:
        yield f"{tag} {text[:10]}", replaced(tag, text)
    yield "an invalid slope", replaced("FloorEnabled", "1").replace(">0.0</FloorSlope", ">90</FloorSlope")
    yield "tags in a value", replaced("DtFrac", "<b>0.9</b>")


def wrong_cells() -> Iterator[tuple[str, str]]:
    """Yield a description and the text of files with invalid layers."""
    for cell in CELLS:
        yield f"cell {cell!r}", TEMPLATE.replace("<Layer><![CDATA[1", f"<Layer><![CDATA[{cell}", 1)
    for offset in OFFSETS:
        yield f"offset {offset!r}", TEMPLATE.replace("<Layer><![CDATA[0, ", f"<Layer><![CDATA[{offset}, ", 1)
    yield "a tag among cells", TEMPLATE.replace("<Layer><![CDATA[1", "<Layer>1<b/><![CDATA[", 1)
    yield "a layer less", TEMPLATE.replace("<Layer>", "<Player>", 1).replace("</Layer>", "</Player>", 1)
    yield "no voxel", re.sub(r"\[[013]+\]", lambda m: f"[{'0' * (len(m[0]) - 2)}]", TEMPLATE)


def wrong_sections() -> Iterator[tuple[str, str]]:
    """Yield a description and the text of files with missing or additional parts."""
    for n in range(1, 50):
        yield f"truncated {n}", TEMPLATE[: len(TEMPLATE) * n // 50]
    for tag in NEEDED:
        yield f"without {tag}", without(tag)
    for tag in ("Damping", "Gravity", "Palette", "X_Voxels", "Elastic_Mod", "DtFrac", "PhaseOffset"):
        yield f"{tag} twice", twice(tag)
    for text in NO_VXA:
        yield f"not vxa {text[:20]!r}", text
    for name, (doctype, text) in DOCTYPES.items():
        start, end = TEMPLATE.replace(HEAD, f"{HEAD}{doctype}").split("</GA>")
        yield name, f"{start}{text}</GA>{end}"


def canvas(x: int, y: int, z: int) -> str:
    changed = TEMPLATE
    for axis, length in zip("XYZ", (x, y, z), strict=True):
        changed = changed.replace(f"<{axis}_Voxels>{6 if axis == 'X' else 3}.0", f"<{axis}_Voxels>{length}")
    return changed


LONG = "0," * 4_000_000

LARGE: dict[str, Callable[[], bytes]] = {
    "a canvas of 1000 x 1000 x 1000": lambda: canvas(1000, 1000, 1000).encode(),
    "a canvas of 2^24 + 1 cells": lambda: canvas(2**24 + 1, 1, 1).encode(),
    "a canvas of 2^24 layers": lambda: canvas(1, 1, 2**24).encode(),
    "a canvas of 2^24 cells in a layer": lambda: canvas(2**12, 2**12, 1).encode(),
    "more than 64 MiB": lambda: bytes(64 * 2**20 + 1),
    "64 MiB of nothing": lambda: bytes(64 * 2**20),
    "deep nesting": lambda: b"<VXA>" * 1_000_000,
    "deep and closed": lambda: b"<VXA>" * 100_000 + b"</VXA>" * 100_000,
    "many elements": lambda: b"<VXA>" + b"<a/>" * 12_000_000 + b"</VXA>",
    "many comments": lambda: b"<VXA>" + b"<!---->a" * 6_000_000 + b"</VXA>",
    "many attributes": lambda: b"<VXA>" + b"<a b='' c='' d='' e='' f=''/>" * 2_000_000 + b"</VXA>",
    "one long name": lambda: b"<" + b"a" * 40_000_000,
    "one long text": lambda: TEMPLATE.replace("Passive_Soft", "a" * 40_000_000).encode(),
    "one long layer": lambda: TEMPLATE.replace("[CDATA[1", f"[CDATA[{'1' * 9_000_000}", 1).encode(),
    "one long layer of offsets": lambda: TEMPLATE.replace("[CDATA[0, ", f"[CDATA[{LONG}", 1).encode(),
    "one long number": lambda: replaced("DtFrac", "1" * 9_000_000).encode(),
}


def contents() -> Iterator[tuple[str, bytes]]:
    """Yield a description and the content of all small files."""
    for name, text in itertools.chain(wrong_values(), wrong_cells(), wrong_sections()):
        yield name, text.encode()
    for encoding in ENCODINGS:
        yield f"in {encoding}", codecs.encode(TEMPLATE.replace("ISO-8859-1", encoding), encoding)
    yield "zipped", zlib.compress(TEMPLATE.encode())
    yield "a NUL", TEMPLATE.replace("Passive_Soft", "\0").encode()
    yield "bytes in a tag", TEMPLATE.replace("<DtFrac>", "<DtFr\x80c>").encode("iso-8859-1")
    for seed in range(5):
        yield f"garbage {seed}", np.random.default_rng(seed).bytes(2000)
    yield "a picture", b"\x89PNG\r\n\x1a\n" + bytes(100)


SMALL = dict(contents())


def test_there_are_over_two_hundred_distinct_files() -> None:
    assert len(SMALL) + len(LARGE) > 200
    assert len(SMALL) == len(list(contents())), "two files have the same description"
    assert len(set(SMALL.values())) == len(SMALL), "two files are equal"
    assert TEMPLATE.encode() not in SMALL.values()


def assert_rejected(path: Path) -> None:
    with pytest.raises((InputError, ConfigurationError)) as caught:
        Vox.settings_of(path)
    assert isinstance(caught.value, EvoframeError)
    assert caught.value.source == str(path)
    message = str(caught.value)
    assert message.isprintable()
    assert len(message) < len(str(path)) + 500


@pytest.mark.parametrize("name", SMALL)
def test_a_malformed_file_is_rejected(name: str, tmp_path: Path) -> None:
    path = tmp_path / "given.vxa"
    path.write_bytes(SMALL[name])
    assert_rejected(path)


@pytest.mark.parametrize("name", list(SMALL)[::4])
def test_the_program_reports_the_file_without_a_traceback(
    name: str, tmp_path: Path, simulated: Callable[[Path], tuple[int, str]]
) -> None:
    path = tmp_path / "given.vxa"
    path.write_bytes(SMALL[name])
    code, complaint = simulated(path)
    assert code == 2
    assert complaint.startswith(f"Error: {path}: ")
    assert "Traceback" not in complaint


_LIMITED = """
import resource, sys
resource.setrlimit(resource.RLIMIT_AS, (1536 * 2**20,) * 2)
from evoframe.cli import main
sys.argv[0] = "evoframe"
main()
"""


@pytest.mark.parametrize("name", LARGE)
def test_the_largest_files_are_rejected_in_little_memory(name: str, tmp_path: Path) -> None:
    path = tmp_path / "given.vxa"
    path.write_bytes(LARGE[name]())
    # numpy's linear algebra would reserve memory for every core.
    finished = python("-c", _LIMITED, "simulate", path, directory=tmp_path, OPENBLAS_NUM_THREADS="1")
    assert finished.returncode == 2
    assert finished.stderr.startswith(f"Error: {path}: ")
    assert "Traceback" not in finished.stderr
    assert len(finished.stderr) < 1000


@pytest.mark.parametrize("make", [None, Path.mkdir])
def test_a_missing_file_or_a_directory_is_rejected(
    tmp_path: Path, make: Callable[[Path], None] | None
) -> None:
    if make:
        make(tmp_path / "given.vxa")
    with pytest.raises(InputError) as caught:
        Vox.settings_of(tmp_path / "given.vxa")
    assert caught.value.source == str(tmp_path / "given.vxa")
    assert isinstance(caught.value.__cause__, OSError)


def test_an_endless_file_is_rejected(tmp_path: Path) -> None:
    (tmp_path / "given.vxa").symlink_to("/dev/zero")
    with pytest.raises(InputError, match="64 MiB") as caught:
        Vox.settings_of(tmp_path / "given.vxa")
    assert caught.value.source == str(tmp_path / "given.vxa")


def test_external_entities_are_not_read(tmp_path: Path) -> None:
    (tmp_path / "secret").write_text("0.9")
    text = TEMPLATE.replace(HEAD, f"{HEAD}<!DOCTYPE VXA [<!ENTITY a SYSTEM '{tmp_path}/secret'>]>")
    path = tmp_path / "given.vxa"
    path.write_text(text.replace("<DtFrac>0.9<", "<DtFrac>&a;<"))
    with pytest.raises(InputError, match=r"DOCTYPE.* ENTITY"):
        Vox.settings_of(path)


@pytest.mark.parametrize("content", [b"", b"PK\x03\x04", TEMPLATE.encode(), bytes(1000)])
def test_a_file_of_another_kind_is_rejected_as_npz(content: bytes, tmp_path: Path) -> None:
    path = tmp_path / "given.npz"
    path.write_bytes(content)
    with pytest.raises(InputError, match=r"\.npz file .* material and phase_cycles") as caught:
        Vox().read(path)
    assert caught.value.source == str(path)


flips = st.lists(st.tuples(st.integers(0, len(TEMPLATE) - 1), st.integers(0, 255)), min_size=1, max_size=6)


@given(flips=flips, length=st.none() | st.integers(0, len(TEMPLATE)))
@settings(max_examples=300)
def test_a_damaged_file_is_either_read_or_rejected(
    flips: list[tuple[int, int]], length: int | None, tmp_path_factory: pytest.TempPathFactory
) -> None:
    changed = bytearray(TEMPLATE.encode())
    for at, byte in flips:
        changed[at] = byte
    path = tmp_path_factory.getbasetemp() / "damaged.vxa"
    path.write_bytes(changed[:length])
    source = str(path)
    try:
        assert Vox.settings_of(path) is not None
    except (InputError, ConfigurationError) as error:
        source = error.source
    assert source == str(path)
