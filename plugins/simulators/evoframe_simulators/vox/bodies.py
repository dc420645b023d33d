"""Validation of bodies as arrays, and bodies in ``.npz`` files."""

from __future__ import annotations

import io
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from evoframe import CONTROLLER, EMPTY, MORPHOLOGY, Design, InputError
from evoframe_simulators.files import naming_source
from evoframe_simulators.npz import PackedArray, open_npz
from evoframe_simulators.vox.limits import MOST_CELLS, MOST_CYCLES
from evoframe_simulators.vox.materials import PaletteMaterial, describe_codes

__all__ = ["check_codes", "check_cycles", "check_design", "read_bodies", "write_body"]


def check_design(design: Design) -> None:
    """Reject a design that is not a body with a controller; the solver checks the values in the cells.

    Raises:
        InputError: The array of the role ``key`` has an unexpected type or shape.
    """
    material, phase = design.roles[MORPHOLOGY], design.roles[CONTROLLER]
    if material.ndim != 3 or material.dtype != np.uint8:
        raise InputError(f"found {_describe_array(material)}, expected uint8[X, Y, Z]", key=MORPHOLOGY)
    if phase.shape != material.shape or phase.dtype != np.float64:
        expected = f"float64{list(material.shape)}"
        raise InputError(f"found {_describe_array(phase)}, expected {expected}", key=CONTROLLER)


def _describe_array(array: NDArray[Any]) -> str:
    return f"{array.dtype}{list(array.shape)}"


def check_codes(material: NDArray[Any], materials: Mapping[int, PaletteMaterial]) -> None:
    """Reject bodies with a cell that is neither empty nor made of one of *materials*.

    Raises:
        InputError: A cell has an unknown code; names the code and the known ones.
    """
    wrong = material[~np.isin(material, (EMPTY, *materials))]
    if wrong.size:
        raise InputError(f"unknown code {wrong[0]}; codes: {describe_codes(materials)}", key="material")


def check_cycles(cycles: NDArray[np.float64], name: str) -> None:
    """Reject phase offsets that are not finite, or too large for single precision to hold a fraction.

    Raises:
        InputError: An offset is out of range; *name* is the key.
    """
    if not np.isfinite(cycles).all():
        raise InputError("found a value that is not finite", key=name)
    largest = float(np.abs(cycles).max(initial=0.0))
    if largest > MOST_CYCLES:
        raise InputError(f"found {largest:g} cycles, expected at most {MOST_CYCLES:g}", key=name)


def read_bodies(
    path: Path, materials: Mapping[int, PaletteMaterial]
) -> list[tuple[str, NDArray[np.uint8], NDArray[np.float64]]]:
    """Return label, material and phase offsets (in cycles) of each body of a file; some may have no voxels.

    Args:
        path: An ``.npz`` file.
        materials: Code -> material of a cell.

    Raises:
        InputError: The file cannot be read, or the array named by ``key`` does not contain bodies.
    """
    with naming_source(path), open_npz(path, ("material", "phase_cycles")) as (material, phase):
        _check_headers(material, phase)
        codes = material.unpack()
        check_codes(codes, materials)
        codes = codes.astype(np.uint8)
        with np.errstate(all="ignore"):  # values beyond double precision become infinite
            cycles: NDArray[np.float64] = phase.unpack().astype(np.float64)
        check_cycles(cycles, "phase_cycles")
    if codes.ndim == 3:
        return [(path.name, codes, cycles)]
    return [(f"{path.name}[{n}]", *body) for n, body in enumerate(zip(codes, cycles, strict=True))]


def write_body(
    material: NDArray[np.uint8], phase_cycles: NDArray[np.float64], acting: NDArray[np.bool_]
) -> bytes:
    """Return a body as an ``.npz`` file, as :func:`read_bodies` reads it; the same bytes for the same body.

    Args:
        material: Codes, ``uint8[X, Y, Z]``.
        phase_cycles: Offsets, ``float64[X, Y, Z]``, cycles.
        acting: Mask of the cells whose offset has an effect, ``bool[X, Y, Z]``; 0 replaces invalid others.

    Raises:
        InputError: An offset with an effect is out of range.
    """
    valid = np.abs(phase_cycles) <= MOST_CYCLES
    offsets = np.where(valid | acting, phase_cycles, 0.0)
    check_cycles(offsets, CONTROLLER)
    file = io.BytesIO()
    np.savez_compressed(file, material=material, phase_cycles=offsets)
    return file.getvalue()


def _check_headers(material: PackedArray, phase: PackedArray) -> None:
    """Reject arrays that cannot be bodies, before they are unpacked."""
    shape = list(material.shape)
    if len(shape) not in (3, 4) or min(shape) < 1:
        raise InputError(f"shape {shape}; expected [X, Y, Z] or [N, X, Y, Z]", key="material")
    if math.prod(shape) > MOST_CELLS:
        raise InputError(
            f"shape {shape} has {math.prod(shape)} cells, expected at most {MOST_CELLS}", key="material"
        )
    if material.dtype.kind not in "ui":
        raise InputError(f"type {material.dtype}; expected integers", key="material")
    if phase.shape != material.shape:
        raise InputError(f"shape {list(phase.shape)}; expected that of material, {shape}", key="phase_cycles")
    if phase.dtype.kind not in "uif":
        raise InputError(f"type {phase.dtype}; expected numbers", key="phase_cycles")
