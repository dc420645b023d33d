"""Reading of bodies from files, and rejection of everything else."""

from __future__ import annotations

import math
import re
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from npz_files import CELLS, DAMAGED, GOLDEN, SOLID, ZERO, bodies, claiming, npy, zipped

from evoframe import InputError
from evoframe_simulators import Vox
from evoframe_simulators.vox import materials_of
from evoframe_simulators.vox.bodies import read_bodies

MATERIALS = materials_of(Vox())


@pytest.mark.parametrize(
    ("content", "key", "problem"),
    [
        *DAMAGED,
        pytest.param(
            bodies(material=np.array([{}], object)[None, None]),
            "material",
            "type object",
            id="a pickle",
        ),
        pytest.param(
            bodies(material=claiming("(1000000000000, 2, 2)")),
            "material",
            r"\[1000000000000, 2, 2\] .* 4000000000000 cells, .* 16777216$",
            id="10^12 cells",
        ),
        pytest.param(
            bodies(material=claiming(f"({2**40}, {2**40}, 1)")), "material", " 16777216$", id="2^80 cells"
        ),
        pytest.param(
            bodies(material=claiming("(-4, -2, 2)")), "material", r"shape \[-4, -2, 2\]", id="negative"
        ),
        pytest.param(
            bodies(material=SOLID[0]),
            "material",
            r"shape \[2, 2\].* \[X, Y, Z\] or \[N, X, Y, Z\]",
            id="flat",
        ),
        pytest.param(
            bodies(material=SOLID[:0], phase_cycles=ZERO[:0]),
            "material",
            r"shape \[0, 2, 2\]",
            id="no cells",
        ),
        pytest.param(bodies(material=SOLID * 1.0), "material", "type float64", id="floats"),
        pytest.param(
            bodies(material=SOLID * 2),
            "material",
            "code 2.* 0 empty, 1 passive, 3 contractile$",
            id="code 2",
        ),
        pytest.param(
            bodies(material=SOLID + np.uint16(256)), "material", "code 257", id="a code beyond uint8"
        ),
        pytest.param(
            bodies(phase_cycles=ZERO[1:]),
            "phase_cycles",
            r"\[3, 2, 2\].* \[4, 2, 2\]",
            id="phase of another shape",
        ),
        pytest.param(
            bodies(phase_cycles=claiming("(1000000000000, 2, 2)", "'<f8'")),
            "phase_cycles",
            r"\[1000000000000, 2, 2\].* \[4, 2, 2\]",
            id="10^12 phases",
        ),
        pytest.param(
            bodies(phase_cycles=np.full(CELLS, "x")), "phase_cycles", "type <U1", id="letters as phase"
        ),
        pytest.param(
            bodies(phase_cycles=claiming(descr=f"'|S{10**9}'")), "phase_cycles", r"type \|S", id="long texts"
        ),
        pytest.param(bodies(phase_cycles=ZERO * math.nan), "phase_cycles", "finite", id="nan"),
        pytest.param(
            bodies(phase_cycles=np.full(CELLS, np.finfo(np.longdouble).max)),
            "phase_cycles",
            "finite|cycles",
            id="long double",
        ),
        pytest.param(
            bodies(phase_cycles=ZERO + 1e300),
            "phase_cycles",
            r" 1e\+300 .* 1e\+06",
            id="many cycles",
        ),
        pytest.param(
            bodies(phase_cycles=np.full(CELLS, np.iinfo(np.int64).min)),
            "phase_cycles",
            r" 9\.22337e\+18 .* 1e\+06",
            id="the int64 without an absolute value",
        ),
    ],
)
def test_a_file_without_bodies_is_rejected(tmp_path: Path, content: bytes, key: str, problem: str) -> None:
    path = tmp_path / "given.npz"
    path.write_bytes(content)
    with pytest.raises(InputError) as caught:
        read_bodies(path, MATERIALS)
    assert caught.value.source == str(path)
    assert caught.value.key == key
    assert re.search(problem, caught.value.problem)


@pytest.mark.parametrize("make", [lambda _: None, Path.mkdir])
def test_a_missing_file_or_a_directory_is_rejected(tmp_path: Path, make: Callable[[Path], None]) -> None:
    make(tmp_path / "given.npz")
    with pytest.raises(InputError) as caught:
        read_bodies(tmp_path / "given.npz", MATERIALS)
    assert caught.value.source == str(tmp_path / "given.npz")
    assert isinstance(caught.value.__cause__, OSError)


@pytest.mark.parametrize("version", [(1, 0), (2, 0), (3, 0)])
@pytest.mark.parametrize("suffix", ["", ".npy"])
@pytest.mark.parametrize("method", [zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED])
def test_every_encoding_of_an_array_is_read(
    tmp_path: Path, version: tuple[int, int], suffix: str, method: int
) -> None:
    path = tmp_path / "given.npz"
    material, phase = np.asfortranarray(SOLID * 3, ">i8"), np.arange(16, dtype=np.int8).reshape(CELLS)
    members = {"phase_cycles": phase, "label": np.array("x"), "material": material}
    path.write_bytes(
        zipped(*((name + suffix, npy(array, version)) for name, array in members.items()), method=method)
    )
    [(label, codes, cycles)] = read_bodies(path, MATERIALS)
    assert label == "given.npz"
    assert codes.dtype == np.uint8
    assert cycles.dtype == np.float64
    assert (codes == 3).all()
    assert (cycles == phase).all()


def test_several_bodies_are_numbered() -> None:
    with np.load(GOLDEN) as arrays:
        material, phase = arrays["material"], arrays["phase_cycles"]
    read = read_bodies(GOLDEN, MATERIALS)
    assert [label for label, _, _ in read] == [f"paper_preset.npz[{n}]" for n in range(36)]
    assert (np.stack([codes for _, codes, _ in read]) == material).all()
    assert (np.stack([cycles for _, _, cycles in read]) == phase).all()


@pytest.fixture(scope="module")
def damaged_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("damage") / "given.npz"


flips = st.lists(st.tuples(st.integers(0, 2**16), st.integers(1, 255)), max_size=4)
lengths = st.none() | st.integers(0, 2**10)
methods = st.sampled_from([zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED])


def damaged(content: bytes, flips: list[tuple[int, int]], length: int | None) -> bytes:
    changed = bytearray(content)
    for at, bits in flips:
        changed[at % len(changed)] ^= bits
    return bytes(changed[:length])


def assert_bodies_or_rejected(path: Path) -> None:
    try:
        read = read_bodies(path, MATERIALS)
    except InputError:
        return
    for _, codes, cycles in read:
        assert codes.dtype == np.uint8
        assert codes.any()
        assert np.isin(codes, (0, 1, 3)).all()
        assert cycles.shape == codes.shape
        assert (np.abs(cycles) <= 1e6).all()


@given(flips=flips, length=lengths, method=methods)
@settings(max_examples=200)
def test_a_damaged_file_is_rejected_unless_it_contains_bodies(
    damaged_file: Path, flips: Any, length: int | None, method: int
) -> None:
    damaged_file.write_bytes(damaged(bodies(method=method), flips, length))
    assert_bodies_or_rejected(damaged_file)


@given(name=st.sampled_from(["material", "phase_cycles"]), flips=flips, length=lengths)
@settings(max_examples=200)
def test_a_damaged_array_in_an_intact_archive_is_rejected_unless_it_is_a_body(
    damaged_file: Path, name: str, flips: Any, length: int | None
) -> None:
    arrays = {"material": npy(SOLID), "phase_cycles": npy(ZERO)}
    damaged_file.write_bytes(bodies(**{**arrays, name: damaged(arrays[name], flips, length)}))
    assert_bodies_or_rejected(damaged_file)
