"""Bodies in files: ``.npz`` with ``material`` and ``phase_cycles``."""

from __future__ import annotations

import zipfile
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from evoframe import Design, InputError

__all__ = ["CONTRACTILE", "EMPTY", "PASSIVE", "check_design", "read_bodies"]

EMPTY, PASSIVE, CONTRACTILE = 0, 1, 3
"""Material codes (3, not 2, is what the authors feed to the controller network and write to files)."""

_MOST_CELLS = 2**24
_MOST_CYCLES = 1e6  # beyond, single precision knows no fraction of a cycle
_KEYS = ("material", "phase_cycles")


def check_design(design: Design) -> None:
    """Refuse a design that is no body with a controller; what its cells hold is checked by the solver.

    Raises:
        InputError: Says what is wrong with its arrays.
    """
    material, phase = design.roles["morphology"], design.roles["controller"]
    if material.ndim != 3 or material.dtype != np.uint8:
        raise InputError(f"morphology is {_described(material)}; expected uint8[X, Y, Z]")
    if phase.shape != material.shape or phase.dtype != np.float64:
        raise InputError(f"controller is {_described(phase)}; expected float64{list(material.shape)}")


def _described(array: NDArray[Any]) -> str:
    return f"{array.dtype}{list(array.shape)}"


def read_bodies(path: Path) -> Iterator[tuple[str, NDArray[np.uint8], NDArray[np.float64]]]:
    """Yield label, material and phase offsets (in cycles) of each body of a file.

    Raises:
        InputError: The file cannot be read, or its arrays are not bodies; says what is wrong.
    """
    material, phase = _read_arrays(path)
    if material.ndim == 3:
        yield path.name, _materials(path, material), _phases(path, phase, material.shape)
        return
    for index, (one, offsets) in enumerate(
        zip(_materials(path, material), _phases(path, phase, material.shape), strict=True)
    ):
        yield f"{path.name}[{index}]", one, offsets


def _read_arrays(path: Path) -> tuple[NDArray[Any], NDArray[Any]]:
    try:
        with zipfile.ZipFile(path) as archive:
            sizes = {entry.filename.removesuffix(".npy"): entry.file_size for entry in archive.infolist()}
        _check_contents(path, sizes)
        with np.load(path, allow_pickle=False) as arrays:
            return arrays["material"], arrays["phase_cycles"]
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror or error}") from error
    except (zipfile.BadZipFile, zlib.error, EOFError, KeyError, ValueError, NotImplementedError) as error:
        raise InputError(f"{path}: is no .npz file with material and phase_cycles: {error}") from error


def _check_contents(path: Path, sizes: dict[str, int]) -> None:
    """Refuse what has the wrong arrays, or would not fit into memory, before anything is unpacked."""
    for key in _KEYS:
        if key not in sizes:
            found = ", ".join(sorted(sizes)) or "nothing"
            raise InputError(
                f"{path}: has no array '{key}'; expected material and phase_cycles, found {found}"
            )
        if sizes[key] > 8 * _MOST_CELLS + 2**16:
            raise InputError(f"{path}: {key} has {sizes[key]} bytes, more than {_MOST_CELLS} voxels")


def _materials(path: Path, material: NDArray[Any]) -> NDArray[np.uint8]:
    if material.ndim not in (3, 4) or 0 in material.shape:
        raise InputError(
            f"{path}: material has the shape {list(material.shape)}; expected [X, Y, Z] or [N, X, Y, Z]"
        )
    if material.dtype.kind not in "ui":
        raise InputError(f"{path}: material has the type {material.dtype}; expected whole numbers")
    wrong = material[~np.isin(material, (EMPTY, PASSIVE, CONTRACTILE))]
    if wrong.size:
        raise InputError(
            f"{path}: material has the code {wrong[0]}; codes: 0 empty, 1 passive, 3 contractile"
        )
    codes: NDArray[np.uint8] = material.astype(np.uint8)
    for index, body in enumerate(codes if codes.ndim == 4 else [codes]):
        if not body.any():
            raise InputError(f"{path}: material: body {index} has no voxel")
    return codes


def _phases(path: Path, phase: NDArray[Any], shape: tuple[int, ...]) -> NDArray[np.float64]:
    if phase.shape != shape:
        raise InputError(
            f"{path}: phase_cycles has the shape {list(phase.shape)}, but material has {list(shape)}"
        )
    if phase.dtype.kind not in "uif":
        raise InputError(f"{path}: phase_cycles has the type {phase.dtype}; expected numbers")
    if not np.isfinite(phase).all():
        raise InputError(f"{path}: phase_cycles has a value that is not finite")
    largest = float(np.abs(phase).max())
    if largest > _MOST_CYCLES:
        raise InputError(f"{path}: phase_cycles has the value {largest:g}; at most {_MOST_CYCLES:g} cycles")
    return phase.astype(np.float64)
