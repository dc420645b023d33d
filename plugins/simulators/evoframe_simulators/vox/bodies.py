"""Bodies as arrays: what they may be, and how they are read from ``.npz`` files."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from evoframe import CONTROLLER, EMPTY, MORPHOLOGY, Design, InputError
from evoframe_simulators.files import naming
from evoframe_simulators.npz import PackedArray, open_npz
from evoframe_simulators.vox.limits import MOST_CELLS, MOST_CYCLES
from evoframe_simulators.vox.materials import PaletteMaterial, described

__all__ = ["check_codes", "check_cycles", "check_design", "read_bodies"]


def check_design(design: Design) -> None:
    """Refuse a design that is no body with a controller; what its cells hold is checked by the solver.

    Raises:
        InputError: Says what is wrong with its arrays.
    """
    material, phase = design.roles[MORPHOLOGY], design.roles[CONTROLLER]
    if material.ndim != 3 or material.dtype != np.uint8:
        raise InputError(f"morphology is {_described(material)}; expected uint8[X, Y, Z]")
    if phase.shape != material.shape or phase.dtype != np.float64:
        raise InputError(f"controller is {_described(phase)}; expected float64{list(material.shape)}")


def _described(array: NDArray[Any]) -> str:
    return f"{array.dtype}{list(array.shape)}"


def check_codes(material: NDArray[Any], materials: Mapping[int, PaletteMaterial]) -> None:
    """Refuse bodies with a cell that is neither empty nor of one of the materials.

    Raises:
        InputError: Says which code was found, and what there is.
    """
    wrong = material[~np.isin(material, (EMPTY, *materials))]
    if wrong.size:
        raise InputError(f"material has the code {wrong[0]}; codes: {described(materials)}")


def check_cycles(cycles: NDArray[np.float64], name: str) -> None:
    """Refuse phase offsets that are not finite, or too large to have a fraction.

    Raises:
        InputError: Says what was found under this name.
    """
    if not np.isfinite(cycles).all():
        raise InputError(f"{name} has a value that is not finite")
    largest = float(np.abs(cycles).max(initial=0.0))
    if largest > MOST_CYCLES:
        raise InputError(f"{name} has the value {largest:g}; at most {MOST_CYCLES:g} cycles")


def read_bodies(
    path: Path, materials: Mapping[int, PaletteMaterial]
) -> list[tuple[str, NDArray[np.uint8], NDArray[np.float64]]]:
    """Return label, material and phase offsets (in cycles) of each body of a file.

    Args:
        path: An ``.npz`` file.
        materials: What a cell may be made of.

    Raises:
        InputError: The file cannot be read, or its arrays are not bodies; says what is wrong.
    """
    with naming(path), open_npz(path, ("material", "phase_cycles")) as (material, phase):
        _check_headers(material, phase)
        codes = material.unpack()
        check_codes(codes, materials)
        without = np.flatnonzero(~codes.any(axis=(-3, -2, -1)))
        if without.size:
            raise InputError(f"material: body {without[0]} has no voxel")
        codes = codes.astype(np.uint8)
        with np.errstate(all="ignore"):  # what double precision cannot hold becomes infinite
            cycles: NDArray[np.float64] = phase.unpack().astype(np.float64)
        check_cycles(cycles, "phase_cycles")
    if codes.ndim == 3:
        return [(path.name, codes, cycles)]
    return [(f"{path.name}[{n}]", *body) for n, body in enumerate(zip(codes, cycles, strict=True))]


def _check_headers(material: PackedArray, phase: PackedArray) -> None:
    """Refuse arrays that cannot be bodies, before they are unpacked."""
    shape = list(material.shape)
    if len(shape) not in (3, 4) or min(shape) < 1:
        raise InputError(f"material has the shape {shape}; expected [X, Y, Z] or [N, X, Y, Z]")
    if math.prod(shape) > MOST_CELLS:
        raise InputError(f"material has the shape {shape}, {math.prod(shape)} cells; at most {MOST_CELLS}")
    if material.dtype.kind not in "ui":
        raise InputError(f"material has the type {material.dtype}; expected whole numbers")
    if phase.shape != material.shape:
        raise InputError(f"phase_cycles has the shape {list(phase.shape)}, but material has {shape}")
    if phase.dtype.kind not in "uif":
        raise InputError(f"phase_cycles has the type {phase.dtype}; expected numbers")
