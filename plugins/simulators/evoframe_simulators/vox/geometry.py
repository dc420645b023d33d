"""Geometry of bodies for figures and pages: moving surfaces, one for each material."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np
from numpy.typing import NDArray

from evoframe import EMPTY, MORPHOLOGY, Design, Geometry, GeometryPart, InputError, Record
from evoframe_simulators.vox.bodies import check_codes, check_design
from evoframe_simulators.vox.materials import PaletteMaterial
from evoframe_simulators.vox.models import clock_of
from evoframe_simulators.vox.settings import VoxSettings, materials_of
from evoframe_simulators.vox.simulation import simulate
from evoframe_simulators.vox.tracks import POINTS

__all__ = ["geometry_of"]

# Red contracts and blue does not: the colorblind-safe "vibrant" scheme of Paul Tol.
_CONTRACTILE = ("#CC3311", "#EE3377", "#EE7733")
_PASSIVE = ("#0077BB", "#33BBEE", "#009988")
_TRANSLUCENT = 0.12

_SQUARE = ((0, 0), (1, 0), (1, 1), (0, 1))  # counter-clockwise

Cells = NDArray[np.bool_]


def geometry_of(settings: VoxSettings, design: Design, frames: int) -> Geometry:
    """Return the surfaces of a body: one part for each material, and one for an enclosure.

    At rest, voxels are drawn as cubes. A moving corner is displaced by the mean displacement of the voxels
    that share it, so that the surface has no gaps; the swelling of voxels at the surface is not drawn. An
    enclosure is an outermost layer of the canvas that consists of one passive material.

    Args:
        settings: Settings of the simulation.
        design: The body with its controller.
        frames: Maximum number of frames, spread evenly over the steps.

    Raises:
        InputError: The design is not a body with a controller, or has no voxels.
        ValueError: *frames* is not positive.
    """
    if frames < 1:
        raise ValueError(f"expected at least 1 frame, found {frames}")
    check_design(design)
    material = design.roles[MORPHOLOGY]
    check_codes(material, materials_of(settings))
    if not material.any():
        raise InputError("has no voxels to draw", key=MORPHOLOGY)
    last = clock_of(settings, material).steps
    steps = np.linspace(0, last, frames).round().astype(int) if frames > 1 else np.zeros(1, int)
    samples = tuple(np.unique(steps[steps > 0] - 1).tolist())
    [outcome] = simulate(settings, [design], Record(("voxels", *POINTS), samples=samples, initial=True))
    sound = outcome.steps < (np.inf if outcome.diverged_at is None else outcome.diverged_at)
    corners = _corners(outcome.tracks["voxels"][sound], settings.voxel_size)
    return Geometry(
        times=outcome.times[sound],
        parts=tuple(_parts(material, materials_of(settings), corners)),
        tracks={name: outcome.tracks[name][sound] for name in POINTS},
    )


def _corners(voxels: NDArray[np.float64], size: float) -> NDArray[np.float64]:
    """Return the positions of the corners of all cells, ``float64[frames, X + 1, Y + 1, Z + 1, 3]``, m.

    Args:
        voxels: Positions of the voxels, ``float64[frames, X, Y, Z, 3]``, m; NaN in empty cells.
        size: Edge of a voxel, m.
    """
    present = np.isfinite(voxels[0, ..., 0])
    first = np.argwhere(present)[0]
    origin = voxels[0][tuple(first)] - (first + 0.5) * size
    lattice = np.stack(np.meshgrid(*(np.arange(n + 1.0) for n in present.shape), indexing="ij"), axis=-1)
    moved = np.where(present[..., None], voxels - voxels[0], 0.0)
    around = _of_corners(present[None, ..., None].astype(np.float64))
    corners: NDArray[np.float64] = origin + lattice * size + _of_corners(moved) / np.maximum(around, 1.0)
    return corners


def _of_corners(cells: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return for each corner the sum over the adjacent cells: ``[frames, X + 1, Y + 1, Z + 1, k]``."""
    padded = np.pad(cells, ((0, 0), (1, 1), (1, 1), (1, 1), (0, 0)))
    for axis in (1, 2, 3):
        size = padded.shape[axis]
        padded = padded.take(range(size - 1), axis) + padded.take(range(1, size), axis)
    return padded


def _parts(
    material: NDArray[np.uint8], materials: Mapping[int, PaletteMaterial], corners: NDArray[np.float64]
) -> Iterator[GeometryPart]:
    enclosing = _enclosure(material, materials)
    opaque = (material != EMPTY) & ~enclosing
    reds, blues = iter(_CONTRACTILE * 100), iter(_PASSIVE * 100)
    for code, made_of in materials.items():
        colour = next(reds if made_of.expansion_coefficient else blues)
        faces = _faces(opaque & (material == code), opaque)
        if faces.size:
            yield _part(made_of.name or f"material {code}", colour, 1.0, faces, corners)
    if enclosing.any():
        faces = _faces(enclosing, material != EMPTY)
        yield _part("enclosure", _PASSIVE[0], _TRANSLUCENT, faces, corners)


def _enclosure(material: NDArray[np.uint8], materials: Mapping[int, PaletteMaterial]) -> Cells:
    """Return a mask of the cells that form the enclosure; all ``False`` without one."""
    outermost = np.ones(material.shape, np.bool_)
    outermost[1:-1, 1:-1, 1:-1] = False
    codes = set(material[outermost].tolist())
    is_one = len(codes) == 1 and EMPTY not in codes and not outermost.all()
    if is_one and materials[codes.pop()].expansion_coefficient == 0.0:
        return outermost
    return np.zeros_like(outermost)


def _faces(cells: Cells, hiding: Cells) -> NDArray[np.int64]:
    """Return the faces of *cells* that no cell in *hiding* covers, as indices of corners, ``int64[m, 4]``."""
    corners = np.arange(np.prod(np.array(cells.shape) + 1)).reshape(np.array(cells.shape) + 1)
    padded = np.pad(hiding, 1)
    found = []
    for axis in range(3):
        for side in (0, 1):
            beside = np.roll(padded, 1 - 2 * side, axis)[1:-1, 1:-1, 1:-1]
            visible = np.argwhere(cells & ~beside)
            # Across y the other two axes are swapped, so that the order remains counter-clockwise.
            square = [np.insert(at[::-1] if axis == 1 else at, axis, side) for at in _SQUARE]
            quads = np.stack([corners[tuple((visible + offset).T)] for offset in square], axis=1)
            found.append(quads if side else quads[:, ::-1])
    return np.concatenate(found)


def _part(
    name: str, colour: str, opacity: float, faces: NDArray[np.int64], corners: NDArray[np.float64]
) -> GeometryPart:
    used, places = np.unique(faces, return_inverse=True)
    vertices = corners.reshape(len(corners), -1, 3)[:, used]
    return GeometryPart(name, colour, opacity, vertices, places.reshape(faces.shape).astype(np.int64))
