"""Arrays in untrusted ``.npz`` files, inspected before they are unpacked."""

from __future__ import annotations

import re
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


@pytest.mark.parametrize(("content", "key", "problem"), DAMAGED)
def test_a_damaged_file_is_rejected_before_or_during_unpacking(
    path: Path, content: bytes, key: str, problem: str
) -> None:
    path.write_bytes(content)
    with pytest.raises(InputError) as caught:
        unpacked(path)
    assert caught.value.key == key
    assert re.search(problem, caught.value.problem)


dtypes = arrays.integer_dtypes() | arrays.unsigned_integer_dtypes() | arrays.floating_dtypes()


@given(
    array=arrays.arrays(dtypes, arrays.array_shapes(min_dims=0, max_dims=4, min_side=0), fill=st.nothing()),
    compressed=st.booleans(),
)
def test_an_array_saved_by_numpy_is_unpacked(
    array: NDArray[Any], compressed: bool, tmp_path_factory: pytest.TempPathFactory
) -> None:
    path = tmp_path_factory.getbasetemp() / "saved.npz"
    save = np.savez_compressed if compressed else np.savez
    save(path, other=np.zeros(3), wanted=array)
    with open_npz(path, ["wanted"]) as [packed]:
        assert (packed.name, packed.shape, packed.dtype) == ("wanted", array.shape, array.dtype)
        np.testing.assert_array_equal(packed.unpack(), array)


def test_arrays_have_the_order_of_the_names() -> None:
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
        with pytest.raises(InputError, match="Object arrays") as caught:
            material.unpack()
        assert caught.value.key == "material"


def test_the_error_for_a_missing_array_names_expected_and_found_ones(path: Path) -> None:
    path.write_bytes(zipped(("b.npy", b""), ("a", b""), method=zipfile.ZIP_DEFLATED))
    with (
        pytest.raises(InputError, match=r"x and y, .* a, b$") as caught,
        open_npz(path, "xy"),
    ):
        pass
    assert caught.value.key == "x"


def test_an_unreadable_file_raises_an_os_error(path: Path) -> None:
    with pytest.raises(FileNotFoundError), open_npz(path, NAMES):
        pass
