"""Arrays in untrusted ``.npz`` files, inspected before they are unpacked."""

from __future__ import annotations

import io
import struct
import tokenize
import warnings
import zipfile
import zlib
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import attrs
import numpy as np
from numpy.lib import format as npy
from numpy.typing import NDArray

from evoframe import InputError

__all__ = ["PackedArray", "open_npz"]

_MOST_HEADER_BYTES = 2**14  # numpy itself rejects headers longer than 10000 characters
_METHODS = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)  # the others unpack without a memory limit
_ENCRYPTED = 0x1

# Exceptions of zipfile, zlib and numpy for damaged files; numpy parses headers as Python, hence the others.
_DAMAGE = (
    zipfile.BadZipFile,
    zlib.error,
    struct.error,
    EOFError,
    ArithmeticError,
    LookupError,
    RuntimeError,
    TypeError,
    ValueError,
    SyntaxError,
    tokenize.TokenError,
    MemoryError,
)


@attrs.frozen
class PackedArray:
    """An array in an archive that has not been unpacked yet.

    Attributes:
        name: Name in the file.
        shape: Shape according to the array's header.
        dtype: Type according to the array's header.
    """

    name: str
    shape: tuple[int, ...]
    dtype: np.dtype[Any]
    _archive: zipfile.ZipFile = attrs.field(repr=False)
    _entry: zipfile.ZipInfo = attrs.field(repr=False)

    def unpack(self) -> NDArray[Any]:
        """Return the array, which requires the memory implied by shape and dtype.

        Raises:
            InputError: The array is damaged.
        """
        with _rejecting_damage("cannot be unpacked", self.name), self._archive.open(self._entry) as file:
            array: NDArray[Any] = npy.read_array(file)  # rejects objects
            return array


@contextmanager
def open_npz(path: Path, names: Sequence[str]) -> Iterator[list[PackedArray]]:
    """Open the arrays *names* of a file; they can be unpacked inside the ``with`` block.

    Raises:
        OSError: The file cannot be read.
        InputError: The file is not an ``.npz`` file, or the array named by ``key`` is missing or unusable.
    """
    with _rejecting_damage(f"not an .npz file with the arrays {' and '.join(names)}"):
        archive = zipfile.ZipFile(path)
    with archive:
        yield [_packed_array(archive, name, names) for name in names]


def _packed_array(archive: zipfile.ZipFile, name: str, names: Sequence[str]) -> PackedArray:
    entry = _entry(archive, name, names)
    with _rejecting_damage("is not an array", name):
        with archive.open(entry) as file:
            head = io.BytesIO(file.read(_MOST_HEADER_BYTES))
        # Version 3 differs from 2 only in non-ASCII names; later versions are rejected during unpacking.
        read = npy.read_array_header_1_0 if npy.read_magic(head) == (1, 0) else npy.read_array_header_2_0
        shape, _, dtype = read(head)
    return PackedArray(name, shape, dtype, archive, entry)


def _entry(archive: zipfile.ZipFile, name: str, names: Sequence[str]) -> zipfile.ZipInfo:
    entries = [entry for entry in archive.infolist() if _name(entry) == name]
    if not entries:
        found = ", ".join(sorted(map(_name, archive.infolist()))) or "nothing"
        raise InputError(f"missing array; expected {' and '.join(names)}, found {found}", key=name)
    if len(entries) > 1:
        raise InputError(f"{len(entries)} arrays have this name; expected one", key=name)
    [entry] = entries
    if entry.flag_bits & _ENCRYPTED:
        raise InputError("encrypted; expected an array saved with numpy.savez", key=name)
    if entry.compress_type not in _METHODS:
        raise InputError(
            f"compression method {entry.compress_type}; expected {zipfile.ZIP_STORED} or "
            f"{zipfile.ZIP_DEFLATED}; save it with numpy.savez or numpy.savez_compressed",
            key=name,
        )
    return entry


def _name(entry: zipfile.ZipInfo) -> str:
    return entry.filename.removesuffix(".npy")


@contextmanager
def _rejecting_damage(problem: str, key: str = "") -> Iterator[None]:
    try:
        with warnings.catch_warnings(action="ignore"):  # Python warns of unusual literals in headers
            yield
    except _DAMAGE as error:
        detail = " ".join(str(error).split())[:200]  # numpy may quote a whole header
        raise InputError(f"{problem}: {detail or type(error).__name__}", key=key) from error
