"""Cells of layers in all encodings: the same cells, and no more memory than they need."""

from __future__ import annotations

import base64
import tracemalloc
import zlib
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, strategies as st

from evoframe import InputError
from evoframe_simulators.vox.vxa.compression import COMPRESSIONS, decode_layer


def encoded(data: bytes) -> str:
    return base64.b64encode(data).decode()


WRITTEN: dict[str, Callable[[bytes], str]] = {
    "ASCII_READABLE": lambda cells: "".join(chr(48 + cell) for cell in cells),
    "LONG_READABLE": lambda cells: ", ".join(map(str, cells)),
    "BASE64": encoded,
    "": encoded,
    "ZLIB": lambda cells: encoded(zlib.compress(cells)),
    "QT_ZLIB": lambda cells: encoded(len(cells).to_bytes(4, "big") + zlib.compress(cells)),
}


def test_every_encoding_has_an_example() -> None:
    assert set(WRITTEN) == set(COMPRESSIONS)


@pytest.mark.parametrize("compression", WRITTEN)
@given(cells=st.binary(min_size=1, max_size=60))
def test_written_cells_are_read(compression: str, cells: bytes) -> None:
    read = decode_layer(WRITTEN[compression](cells), compression, len(cells))
    assert read.tolist() == list(cells)


@pytest.mark.parametrize("compression", WRITTEN)
@pytest.mark.parametrize("other", [-1, 1, 5])
def test_another_number_of_cells_is_rejected(compression: str, other: int) -> None:
    with pytest.raises(InputError, match=r"found \d+.* cells.*, expected \d+$"):
        decode_layer(WRITTEN[compression](bytes(6)), compression, 6 + other)


@pytest.mark.parametrize("compression", ["BASE64", "ZLIB", "QT_ZLIB"])
def test_line_breaks_in_base64_are_accepted(compression: str) -> None:
    text = WRITTEN[compression](bytes(range(90)))
    lines = "\n".join(text[start : start + 20] for start in range(0, len(text), 20))
    assert decode_layer(lines, compression, 90).tolist() == list(range(90))


@pytest.mark.parametrize(
    ("compression", "text", "problem"),
    [
        ("BASE64", "120213", "BASE64"),
        ("BASE64", "*" * 8, "BASE64"),
        ("BASE64", "é" * 8, "BASE64"),
        ("ZLIB", "120213==", "BASE64|zlib"),
        ("ZLIB", encoded(bytes(6)), "zlib"),
        ("ZLIB", encoded(zlib.compress(bytes(6))[:-3]), "cut off"),
        ("QT_ZLIB", encoded(b"\0\0"), "0 or more|0 cells"),
        ("LONG_READABLE", "1,2,x,1,1,1", "cell 'x'"),
        ("LONG_READABLE", "1,2,-1,1,1,1", "cell '-1'"),
        ("LONG_READABLE", "1,2,1.5,1,1,1", r"cell '1\.5'"),
        ("LONG_READABLE", f"1,2,{'9' * 5000},1,1,1", "cell '999"),
        ("LONG_READABLE", "1,2,\N{ARABIC-INDIC DIGIT THREE},1,1,1", "cell"),
        ("LONG_READABLE", "", "0 cells"),
        ("LONG_READABLE", "1 2 1 1 1 1", "1 cells between commas"),
    ],
)
def test_other_texts_are_rejected(compression: str, text: str, problem: str) -> None:
    with pytest.raises(InputError, match=problem):
        decode_layer(text, compression, 6)


def test_a_bomb_is_not_unpacked() -> None:
    text = WRITTEN["ZLIB"](bytes(200 * 2**20))
    tracemalloc.start()
    with pytest.raises(InputError, match="found 7 or more cells"):
        decode_layer(text, "ZLIB", 6)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 2**22


@given(
    cells=st.binary(min_size=1, max_size=30),
    flips=st.lists(st.tuples(st.integers(0, 60), st.integers(0, 255))),
)
def test_damaged_data_is_read_or_rejected(cells: bytes, flips: list[tuple[int, int]]) -> None:
    data = bytearray(zlib.compress(cells))
    for at, byte in flips:
        data[at % len(data)] = byte
    try:
        read = decode_layer(encoded(bytes(data)), "ZLIB", len(cells))
    except InputError:
        return
    assert read.dtype == np.int64
    assert len(read) == len(cells)
