"""Arrays in ``.npz`` files from anyone: looked at before they are unpacked."""

from __future__ import annotations

import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, strategies as st
from hypothesis.extra import numpy as arrays
from npz_files import DAMAGED, GOLDEN, bodies, claiming, zipped
from numpy.typing import NDArray

from evoframe import InputError
from evoframe_simulators.npz import open_npz

NAMES = ("material", "phase_cycles")


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "given.npz"


def unpacked(path: Path) -> list[NDArray[Any]]:
    with open_npz(path, NAMES) as found:
        return [array.unpack() for array in found]


@pytest.mark.parametrize(("content", "message"), DAMAGED)
def test_what_is_damaged_is_refused_before_or_when_it_is_unpacked(
    path: Path, content: bytes, message: str
) -> None:
    path.write_bytes(content)
    with pytest.raises(InputError, match=message):
        unpacked(path)


dtypes = arrays.integer_dtypes() | arrays.unsigned_integer_dtypes() | arrays.floating_dtypes()


@given(
    array=arrays.arrays(dtypes, arrays.array_shapes(min_dims=0, max_dims=4, min_side=0), fill=st.nothing()),
    compressed=st.booleans(),
)
def test_what_numpy_saves_is_unpacked(
    array: NDArray[Any], compressed: bool, tmp_path_factory: pytest.TempPathFactory
) -> None:
    path = tmp_path_factory.getbasetemp() / "saved.npz"
    save = np.savez_compressed if compressed else np.savez
    save(path, other=np.zeros(3), wanted=array)
    with open_npz(path, ["wanted"]) as [packed]:
        assert (packed.name, packed.shape, packed.dtype) == ("wanted", array.shape, array.dtype)
        np.testing.assert_array_equal(packed.unpack(), array)


def test_arrays_come_in_the_order_in_which_they_are_asked_for() -> None:
    for names in (NAMES, NAMES[::-1]):
        with open_npz(GOLDEN, names) as found:
            assert tuple(array.name for array in found) == names


def test_a_shape_is_known_before_anything_is_unpacked(path: Path) -> None:
    path.write_bytes(bodies(material=claiming("(1000000000000, 2, 2)")))
    with open_npz(path, NAMES) as [material, _]:
        assert material.shape == (10**12, 2, 2)
        assert material.dtype == np.uint8


def test_objects_are_never_unpacked(path: Path) -> None:
    path.write_bytes(bodies(material=np.array([{}], object)))
    with open_npz(path, NAMES) as [material, _]:
        assert material.dtype == object
        with pytest.raises(InputError, match=r"^material cannot be unpacked: Object arrays cannot be loaded"):
            material.unpack()


def test_what_was_found_instead_is_named(path: Path) -> None:
    path.write_bytes(zipped(("b.npy", b""), ("a", b""), method=zipfile.ZIP_DEFLATED))
    with (
        pytest.raises(InputError, match=r"^has no array 'x'; expected x and y, found a, b$"),
        open_npz(path, "xy"),
    ):
        pass


def test_a_file_that_cannot_be_read_is_left_to_the_caller(path: Path) -> None:
    with pytest.raises(FileNotFoundError), open_npz(path, NAMES):
        pass
