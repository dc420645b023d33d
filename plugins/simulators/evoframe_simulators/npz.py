"""Arrays in ``.npz`` files from anyone: looked at before they are unpacked."""

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

_MOST_HEADER_BYTES = 2**14  # numpy itself trusts no header of more than 10000 characters
_METHODS = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)  # the others unpack without a limit to memory
_ENCRYPTED = 0x1

# What zipfile, zlib and numpy raise for files that are damaged; a header is parsed as Python, hence the rest.
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
    """An array that is not unpacked yet.

    Attributes:
        name: Its name in the file.
        shape: What its header claims.
        dtype: What its header claims.
    """

    name: str
    shape: tuple[int, ...]
    dtype: np.dtype[Any]
    _archive: zipfile.ZipFile = attrs.field(repr=False)
    _entry: zipfile.ZipInfo = attrs.field(repr=False)

    def unpack(self) -> NDArray[Any]:
        """Return the array, which takes as much memory as shape and dtype say.

        Raises:
            InputError: It is damaged.
        """
        with _refusing_damage(f"{self.name} cannot be unpacked"), self._archive.open(self._entry) as file:
            array: NDArray[Any] = npy.read_array(file)  # which refuses objects
            return array


@contextmanager
def open_npz(path: Path, names: Sequence[str]) -> Iterator[list[PackedArray]]:
    """Open the arrays *names* of a file; they can be unpacked until it is closed.

    Raises:
        OSError: The file cannot be read.
        InputError: It is something else, or one of the arrays is missing or unusable; says which.
    """
    with _refusing_damage(f"is no .npz file with {' and '.join(names)}"):
        archive = zipfile.ZipFile(path)
    with archive:
        yield [_packed_array(archive, name, names) for name in names]


def _packed_array(archive: zipfile.ZipFile, name: str, names: Sequence[str]) -> PackedArray:
    entry = _entry(archive, name, names)
    with _refusing_damage(f"{name} is no array"):
        with archive.open(entry) as file:
            head = io.BytesIO(file.read(_MOST_HEADER_BYTES))
        # Version 3 differs from 2 in what is not ASCII; later ones are refused when unpacked.
        read = npy.read_array_header_1_0 if npy.read_magic(head) == (1, 0) else npy.read_array_header_2_0
        shape, _, dtype = read(head)
    return PackedArray(name, shape, dtype, archive, entry)


def _entry(archive: zipfile.ZipFile, name: str, names: Sequence[str]) -> zipfile.ZipInfo:
    entries = [entry for entry in archive.infolist() if _name(entry) == name]
    if not entries:
        found = ", ".join(sorted(map(_name, archive.infolist()))) or "nothing"
        raise InputError(f"has no array '{name}'; expected {' and '.join(names)}, found {found}")
    if len(entries) > 1:
        raise InputError(f"has {len(entries)} arrays '{name}'; expected one")
    [entry] = entries
    if entry.flag_bits & _ENCRYPTED:
        raise InputError(f"{name} is encrypted; expected what numpy.savez writes")
    if entry.compress_type not in _METHODS:
        raise InputError(
            f"{name} is compressed with method {entry.compress_type}; expected what numpy.savez or "
            f"numpy.savez_compressed writes (methods {zipfile.ZIP_STORED} and {zipfile.ZIP_DEFLATED})"
        )
    return entry


def _name(entry: zipfile.ZipInfo) -> str:
    return entry.filename.removesuffix(".npy")


@contextmanager
def _refusing_damage(what: str) -> Iterator[None]:
    try:
        with warnings.catch_warnings(action="ignore"):  # of Python about headers that are odd literals
            yield
    except _DAMAGE as error:
        detail = " ".join(str(error).split())[:200]  # numpy may quote a whole header
        raise InputError(f"{what}: {detail or type(error).__name__}") from error
