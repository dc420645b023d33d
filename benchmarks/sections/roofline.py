"""Speed of the kernels relative to the measured peak of a core."""

from __future__ import annotations

from collections.abc import Mapping

import attrs
import numpy as np

from benchmarks.peaks import INSTRUCTIONS, Peak, bandwidth, peak
from benchmarks.report import Row, Section, Table
from benchmarks.subjects import bonds_of, model, solid, solving
from benchmarks.timing import Effort, interleaved
from evoframe import MORPHOLOGY
from evoframe_libvox import KERNELS

__all__ = ["roofline"]


@attrs.frozen
class Work:
    """Operations on doubles: additions, subtractions and multiplications; divisions; square roots.

    Changes of sign, absolute values, comparisons, selections and the arithmetic of indices are not counted;
    common subexpressions are counted once.
    """

    operations: int
    divisions: int = 0
    roots: int = 0

    def __add__(self, other: Work) -> Work:
        """Return the sum of both."""
        return Work(
            self.operations + other.operations, self.divisions + other.divisions, self.roots + other.roots
        )


# Counted in libvox/kernels/vector_bonds.h and vector_motion.h, function by function; there is one coupling.
_MATRIX = Work(29)  # matrix_of: 10 products, 7 sums for the diagonal, 6 sums and 6 doublings off it
_TURN = Work(15)  # turn, turn_back
_CHORD = Work(10)  # chord_ratio: 8 of the power series, with a difference before and a doubling after
_ARC = Work(28)  # short_arc_ratio: the polynomial; its difference is that of the chord

_LOOK = Work(3 + 28 + 2 + 1 + 8) + _TURN  # apart, quaternion product, rest, aside, limits; to the frame
_STRAIGHTEN = Work(5 + 12 + 20, divisions=1, roots=2)  # length, onto_x, quaternion product
# stretch, turn of the upper end, sums of last turns; force, twist, moments of the lower and the upper end
_PULL = Work(1 + 3 + 2 + 17 + 3 + 18 + 12) + _CHORD + _TURN + _TURN
# turn of the lower end, sums of turns, turned_back; moment of the lower end
_PULL_LARGE = Work(2 + 2 + 20 + 3) + _CHORD + _MATRIX + _TURN
_ADD = Work(6)  # force and moment of an end, to those of the tile or of the voxels

SMALL_FRAME = _LOOK + _PULL + _ADD + _ADD
"""Work of a bond's step in the small frame."""

LARGE_FRAME = SMALL_FRAME + _STRAIGHTEN + _PULL_LARGE
"""Work of a bond's step in a tile where some bond is in the large frame."""

TURNED_FAR = LARGE_FRAME + _ARC + _ARC
"""Work of a bond's step in a tile where some bond is turned far, but none by more than 120 degrees."""

_MOVE = Work(7 + 6 + 3 + 6 + 3 + 5 + 5)  # load, momentum, velocity, position, way, two squares
_ROTATE = Work(9 + 3 + 28 + 8 + 7 + 4 + 6, divisions=1, roots=1)  # turn_tile, in the order of its lines
_SIZE = Work(7)

VOXEL = _MATRIX + _TURN + Work(3) + _MOVE + _ROTATE + _SIZE
"""Work of a voxel's step: its frame, the moment on it as a lower end, and its motion."""

# Minimum number of doubles read and written in a step: each array once for all bonds, once for the motion.
# A bond reads `depth`, `small` and the eight of the last deformation, and writes all of them but `depth`, and
# force and moment on its upper end, which are read once more.
_BOND_DOUBLES = (10 + 9 + 6 + 6) * 3  # per voxel, which has bonds along three axes
_END_DOUBLES = 8 + 6  # position, orientation, size; force and torque, written
_MOTION_DOUBLES = 32 + 14  # of move_tile, turn_tile and size_tile: read, written
VOXEL_BYTES = 8 * (_BOND_DOUBLES + _END_DOUBLES + _MOTION_DOUBLES)
"""Memory traffic of a step of a voxel with its bonds, bytes."""

ARRAYS = 3 * 16 + 32
"""Number of arrays of doubles that the kernels use for a body."""

_BATCH = 8
_MEMORY = 192 * 2**20  # beyond any cache, bytes


def roofline(effort: Effort) -> Section:
    """Compare the solid canvas at rest with the peak of a core."""
    seconds = max(effort.shortest, 0.002)
    kernels = [kernel for kernel in KERNELS if kernel in INSTRUCTIONS]
    peaks = {kernel: peak(kernel, seconds) for kernel in kernels}
    held = 8 * ARRAYS * solid().roles[MORPHOLOGY].size
    near = {kernel: bandwidth(kernel, held, seconds) for kernel in kernels}
    far = bandwidth(kernels[-1], _MEMORY, seconds)
    return Section(
        "operations and bytes against the measured peak of a core",
        (_work(), _peaks(peaks, near, held, far), _fractions(_measured(effort, kernels), peaks, near)),
    )


def _measured(effort: Effort, kernels: list[str]) -> dict[str, float]:
    """Return the time of a bond-step at rest, s: all bonds are in the small frame."""
    actions = {
        kernel: solving(
            model(kernel=kernel, whole_body=True, passive=True, self_collision=False), [solid()] * _BATCH
        )
        for kernel in kernels
    }
    steps = int(model().time_steps(np.stack([solid().roles[MORPHOLOGY]]))[1][0])
    bond_steps = _BATCH * bonds_of(solid()) * steps
    return {kernel: taken / bond_steps for kernel, taken in interleaved(actions, effort).items()}


def _voxels_per_bond() -> float:
    return float((solid().roles[MORPHOLOGY] != 0).sum() / bonds_of(solid()))


def _work() -> Table:
    rows = (
        ("bond, small frame", SMALL_FRAME),
        ("bond, large frame", LARGE_FRAME),
        ("bond, large frame and turned far", TURNED_FAR),
        ("voxel: its frame and its motion", VOXEL),
    )
    return Table(
        "Work of a step, counted in libvox/kernels/vector_bonds.h and vector_motion.h",
        ("", "add and multiply", "divide", "square root"),
        tuple((name, work.operations, work.divisions, work.roots) for name, work in rows),
        f"Traffic: {VOXEL_BYTES:,} bytes per voxel with its bonds and its motion, "
        f"{VOXEL_BYTES * _voxels_per_bond():.0f} per bond on the solid canvas, in {ARRAYS} arrays.",
    )


def _peaks(peaks: Mapping[str, Peak], near: Mapping[str, float], held: int, far: float) -> Table:
    rows: list[Row] = [
        (
            kernel,
            found.operations / 1e9,
            found.divisions / 1e9,
            found.roots / 1e9,
            near[kernel] / 1e9,
        )
        for kernel, found in peaks.items()
    ]
    return Table(
        "Measured peak of a core, without fused multiply-add",
        ("instructions", "add and multiply, 1e9/s", "divide, 1e9/s", "square root, 1e9/s", "traffic, GB/s"),
        rows,
        f"benchmarks/peaks.c, the best of five. Traffic: two arrays read, one written, {held / 1000:.0f} kB, "
        "the size that the kernels use for the solid canvas; beyond the caches, in "
        f"{_MEMORY / 2**20:.0f} MiB, it is {far / 1e9:.3g} GB/s.",
    )


def _fractions(measured: Mapping[str, float], peaks: Mapping[str, Peak], near: Mapping[str, float]) -> Table:
    voxels = _voxels_per_bond()
    operations = SMALL_FRAME.operations + VOXEL.operations * voxels
    rows: list[Row] = []
    for kernel, taken in measured.items():
        arithmetic = operations / peaks[kernel].operations
        division = voxels * (VOXEL.divisions / peaks[kernel].divisions + VOXEL.roots / peaks[kernel].roots)
        traffic = VOXEL_BYTES * voxels / near[kernel]
        limits = (arithmetic, division, traffic)
        rows.append(
            (
                kernel,
                1e9 * taken,
                *(1e9 * limit for limit in limits),
                operations / taken / 1e9,
                max(limits) / taken,
            )
        )
    return Table(
        "Limits of a bond-step of the solid canvas at rest, ns",
        (
            "kernel",
            "measured",
            "arithmetic",
            "divide and root",
            "traffic",
            "1e9/s reached",
            "fraction of the limit",
        ),
        rows,
        f"A bond in the small frame and its part of a voxel: {operations:.0f} operations, "
        f"{operations / (VOXEL_BYTES * voxels):.2f} per byte. The limit is the greatest of the three. Not "
        "counted: missing bonds and empty cells, which are computed too, set-up and samples.",
    )
