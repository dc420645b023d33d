"""``.npz`` files with bodies of voxels, sound and damaged."""

from __future__ import annotations

import bz2
import io
import warnings
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

GOLDEN = Path(__file__).parents[1] / "data" / "paper_preset.npz"

CELLS = (4, 2, 2)
SOLID = np.ones(CELLS, np.uint8)
ZERO = np.zeros(CELLS)


def npy(array: Any, version: tuple[int, int] | None = None) -> bytes:
    file = io.BytesIO()
    with warnings.catch_warnings(action="ignore"):  # numpy warns of versions other than 1
        np.lib.format.write_array(file, np.asarray(array), version)
    return file.getvalue()


def header(text: str, version: int = 1) -> bytes:
    """Return an NPY file with this header and 16 bytes of data."""
    length = len(text).to_bytes(2 if version == 1 else 4, "little")
    return b"\x93NUMPY" + bytes([version, 0]) + length + text.encode() + bytes(16)


def claiming(shape: str = "(4, 2, 2)", descr: str = "'|u1'") -> bytes:
    return header(f"{{'descr': {descr}, 'fortran_order': False, 'shape': {shape}}}\n")


def zipped(
    *members: tuple[str, bytes], method: int = zipfile.ZIP_STORED, change: Callable[[bytes], bytes] = bytes
) -> bytes:
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", method) as archive, warnings.catch_warnings(action="ignore"):
        for name, content in members:  # zipfile warns of duplicate names
            archive.writestr(name, content)
    return change(file.getvalue())


def bodies(material: Any = SOLID, phase_cycles: Any = ZERO, **options: Any) -> bytes:
    """Return an .npz file with members given as arrays or bytes."""
    members = {"material.npy": material, "phase_cycles.npy": phase_cycles}
    packed = ((name, given if isinstance(given, bytes) else npy(given)) for name, given in members.items())
    return zipped(*packed, **options)


def encrypted(content: bytes) -> bytes:
    """Set the encryption flag in both headers of every entry."""
    changed = bytearray(content)
    for signature, offset in ((b"PK\x03\x04", 6), (b"PK\x01\x02", 8)):
        at = content.find(signature)
        while at >= 0:
            changed[at + offset] |= 1
            at = content.find(signature, at + 1)
    return bytes(changed)


def garbled(content: bytes) -> bytes:
    """Overwrite the compressed bytes of the first entry."""
    start = 30 + len("material.npy")
    return content[:start] + b"\xff" * 20 + content[start + 20 :]


def renamed(before: bytes, after: bytes) -> Callable[[bytes], bytes]:
    return lambda content: content.replace(before, after)


DAMAGED = [
    pytest.param(b"", "", r"\.npz file", id="nothing"),
    pytest.param(b"\x89PNG\r\n" + bytes(100), "", r"\.npz file", id="a picture"),
    pytest.param(npy(SOLID), "", r"\.npz file", id="an array alone"),
    pytest.param(GOLDEN.read_bytes()[:5000], "", r"\.npz file", id="truncated"),
    pytest.param(
        zipped(("bodies.npy", npy(SOLID))),
        "material",
        "missing array.* material and phase_cycles, .* bodies$",
        id="other arrays",
    ),
    pytest.param(zipped(), "material", "missing array.* nothing$", id="no arrays"),
    pytest.param(
        zipped(("material.npy", npy(SOLID))), "phase_cycles", "missing array.* material$", id="no phase"
    ),
    pytest.param(
        zipped(("a/material.npy", npy(SOLID)), ("a/phase_cycles.npy", npy(ZERO))),
        "material",
        "missing array.* a/material, a/phase_cycles$",
        id="in a directory",
    ),
    pytest.param(
        zipped(*[("material.npy", npy(SOLID))] * 2, ("phase_cycles.npy", npy(ZERO))),
        "material",
        "^2 arrays",
        id="one name twice",
    ),
    pytest.param(
        zipped(("material.npy", npy(SOLID)), ("material", npy(SOLID)), ("phase_cycles", npy(ZERO))),
        "material",
        "^2 arrays",
        id="one name with and without suffix",
    ),
    pytest.param(
        bodies(change=encrypted),
        "material",
        "encrypted",
        id="encrypted",
    ),
    pytest.param(bodies(method=zipfile.ZIP_LZMA), "material", "method 14", id="lzma"),
    pytest.param(
        bodies(method=zipfile.ZIP_BZIP2, change=renamed(bz2.compress(npy(SOLID))[:9], bytes(9))),
        "material",
        "method 12",
        id="corrupt bzip2",
    ),
    pytest.param(
        bodies(method=zipfile.ZIP_DEFLATED, change=garbled),
        "material",
        "array: Error -3",
        id="deflate",
    ),
    pytest.param(bodies(change=garbled), "material", "array: Bad CRC-32", id="checksum"),
    pytest.param(
        bodies(change=renamed(bytes(100), bytes(99) + b"\1")),
        "phase_cycles",
        "array: Bad CRC-32",
        id="a bit of the phase",
    ),
    pytest.param(bodies(material=b"1, 1, 3"), "material", "array: EOF", id="a text"),
    pytest.param(bodies(material=b"x" * 500), "material", "array: .*magic string", id="a long text"),
    pytest.param(bodies(material=b""), "material", "array: EOF", id="an empty member"),
    pytest.param(bodies(material=claiming()[:-8]), "material", "unpacked: EOF", id="half the data"),
    pytest.param(bodies(material=header("{")), "material", "array: ", id="half a header"),
    pytest.param(bodies(material=header("3")), "material", "array: Header", id="no dictionary"),
    pytest.param(bodies(material=header("(" * 5000)), "material", "array: .{3,200}$", id="nested brackets"),
    pytest.param(
        bodies(material=header("-" * 9000 + "1")), "material", "array: .{3,200}$", id="nested signs"
    ),
    pytest.param(bodies(material=header(" " * 20000)), "material", "array: EOF", id="a long header"),
    pytest.param(
        bodies(material=b"\x93NUMPY\2\0\xff\xff\xff\xff"), "material", "array: EOF", id="a header of 4 GB"
    ),
    pytest.param(
        bodies(material=header(claiming()[10:-16].decode(), 9)),
        "material",
        "unpacked: .*format version",
        id="a version to come",
    ),
    pytest.param(bodies(material=claiming(descr="()")), "material", "array: ", id="no type"),
    pytest.param(
        bodies(phase_cycles=claiming(descr="'<f8'")),
        "phase_cycles",
        "unpacked: EOF",
        id="no phases",
    ),
]
"""Files without two intact arrays, with the key of the error and a pattern in its problem."""
