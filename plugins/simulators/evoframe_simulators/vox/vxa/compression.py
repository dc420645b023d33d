"""Cells of a layer, in the encodings that the attribute ``Compression`` of a structure names."""

from __future__ import annotations

import base64
import zlib
from collections.abc import Callable, Mapping
from string import whitespace

import numpy as np
from numpy.typing import NDArray

from evoframe import InputError
from evoframe_simulators.vox.vxa.document import shorten
from evoframe_simulators.vox.vxa.file import FIRST_CHARACTER

__all__ = ["COMPRESSIONS", "decode_layer"]

_QT_LENGTH = 4  # bytes; Qt writes the uncompressed length before the data
_MOST_DIGITS = 8  # of a code between commas; more are no code


def decode_layer(text: str, compression: str, cells: int) -> NDArray[np.int64]:
    """Return the materials of a layer as positions in the palette, ``int64[cells]``, unchecked.

    A compressed layer is never unpacked beyond one byte more than *cells*, since the file is untrusted.

    Args:
        text: The layer without surrounding whitespace.
        compression: A key of :data:`COMPRESSIONS`.
        cells: Expected number of cells.

    Raises:
        InputError: The text is not in this encoding, or has another number of cells.
    """
    codes = COMPRESSIONS[compression](text, cells)
    if len(codes) != cells:
        more = " or more" if len(codes) > cells and compression in ("ZLIB", "QT_ZLIB") else ""
        raise InputError(f"found {len(codes)}{more} cells, expected {cells}")
    return codes


def _characters(text: str, _: int) -> NDArray[np.int64]:
    return np.frombuffer(text.encode("utf-32-le"), "<u4").astype(np.int64) - FIRST_CHARACTER


def _numbers(text: str, cells: int) -> NDArray[np.int64]:
    items = text.removesuffix(",")  # a comma may follow the last cell
    count = items.count(",") + 1 if items else 0
    if count != cells:  # before creating the strings
        raise InputError(f"found {count} cells between commas, expected {cells}")
    codes = np.empty(cells, np.int64)
    for n, item in enumerate(items.split(",")):
        code = item.strip(whitespace)
        if not (code.isascii() and code.isdigit() and len(code) <= _MOST_DIGITS):
            raise InputError(f"found cell {shorten(item)}, expected the number of a material")
        codes[n] = int(code)
    return codes


def _bytes(text: str, _: int) -> NDArray[np.int64]:
    return np.frombuffer(_from_base64(text), np.uint8).astype(np.int64)


def _deflated(text: str, cells: int) -> NDArray[np.int64]:
    return _inflate(_from_base64(text), cells)


def _deflated_by_qt(text: str, cells: int) -> NDArray[np.int64]:
    return _inflate(_from_base64(text)[_QT_LENGTH:], cells)


def _from_base64(text: str) -> bytes:
    try:
        return base64.b64decode("".join(text.split()), validate=True)
    except ValueError as error:
        raise InputError("is not in BASE64") from error


def _inflate(data: bytes, cells: int) -> NDArray[np.int64]:
    inflating = zlib.decompressobj()
    try:
        unpacked = inflating.decompress(data, cells + 1)
    except zlib.error as error:
        raise InputError("is not compressed by zlib") from error
    if len(unpacked) == cells and not inflating.eof:
        raise InputError("is cut off: the compressed data lacks its end")
    return np.frombuffer(unpacked, np.uint8).astype(np.int64)


COMPRESSIONS: Mapping[str, Callable[[str, int], NDArray[np.int64]]] = {
    "ASCII_READABLE": _characters,
    "LONG_READABLE": _numbers,
    "BASE64": _bytes,
    "ZLIB": _deflated,
    "QT_ZLIB": _deflated_by_qt,
    "": _bytes,  # of the engine, whatever the name
}
"""Name in the file -> decoder. ``ASCII_READABLE`` has a character for each cell, ``LONG_READABLE`` (older
VoxCAD) numbers between commas, ``BASE64`` a byte for each cell, and ``ZLIB``, which VoxCAD writes, the same
compressed by zlib; ``QT_ZLIB`` has the length before it. Without a name the engine expects ``BASE64``."""
