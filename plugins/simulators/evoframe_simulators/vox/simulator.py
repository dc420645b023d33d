"""The simulator ``vox``: clamped or free bodies of voxels, some of which contract periodically."""

from __future__ import annotations

import functools
import hashlib
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, ClassVar, Self

import attrs
import numpy as np
from numpy.typing import NDArray

import evoframe_libvox as libvox
from evoframe import (
    CONTROLLER,
    MORPHOLOGY,
    ConfigurationError,
    Design,
    Export,
    FileContents,
    FileOptions,
    Geometry,
    InputError,
    Outcome,
    Record,
    Variant,
)
from evoframe_simulators.files import naming_source
from evoframe_simulators.vox.bodies import check_codes, check_design, read_bodies, write_body
from evoframe_simulators.vox.geometry import geometry_of
from evoframe_simulators.vox.materials import PaletteMaterial
from evoframe_simulators.vox.models import (
    acting_codes,
    clock_of,
    model_of,
    possible_clocks,
    strip_body_index,
)
from evoframe_simulators.vox.objectives import objective_of
from evoframe_simulators.vox.published import published_bodies
from evoframe_simulators.vox.sampling import check_samples
from evoframe_simulators.vox.settings import VoxSettings, materials_of, phase_cycles
from evoframe_simulators.vox.simulation import simulate
from evoframe_simulators.vox.tracks import POINTS, check_tracks
from evoframe_simulators.vox.verification import MEANINGS, changes
from evoframe_simulators.vox.vxa import DIALECTS, SUFFIXES, left_out, read_vxa, write_vxa

__all__ = ["Vox"]


@attrs.frozen(cache_hash=True)  # models and clocks are cached by it
class Vox(VoxSettings):
    """Voxel simulator on libvox; defaults from the paper (docs/experiment.md, "The simulation of a pair").

    By default the slab x = 0 of the canvas is clamped in all six degrees of freedom, without gravity or
    floor. A design without voxels counts as diverged at step 0. Besides the points, ``vox`` can record
    ``voxels``, ``energy``, ``strain`` and ``momentum`` (see ``evoframe_simulators.vox.tracks``). The options
    are the fields of :class:`~evoframe_simulators.vox.settings.VoxSettings`.
    """

    requires: ClassVar[tuple[str, ...]] = (MORPHOLOGY, CONTROLLER)
    tracks: ClassVar[tuple[libvox.Track, ...]] = POINTS
    formats: ClassVar[tuple[str, ...]] = ("vxa", "npz")
    dialects: ClassVar[tuple[str, ...]] = DIALECTS
    batch_size: ClassVar[int] = 12  # designs often share their body, which is prepared once

    # Raise this number by hand with every change of a bit of a result, in libvox or in this package, and name
    # the change in CHANGELOG.md under "Changed bits". Runs without a number have generation 1.
    bit_generation: ClassVar[int] = 2

    def __attrs_post_init__(self) -> None:
        possible_clocks(self)  # raises if the solver rejects the combination

    def check(self, record: Record) -> None:
        """Reject a record with an unknown track or a missing sample, or that ends before ``record.until``.

        Raises:
            ConfigurationError: The record cannot be produced; names the available tracks or samples.
        """
        check_tracks(record.tracks)
        check_samples(record, possible_clocks(self), self.duration)

    def key(self, design: Design, record: Record) -> bytes:
        """Return a digest of the body, the offsets that have an effect, and the record.

        Raises:
            InputError: The design is not a body with a controller.
        """
        check_design(design)
        material = design.roles[MORPHOLOGY]
        begun, acting = _begun_key(self, material.shape, material.tobytes(), record)
        offsets = phase_cycles(self, design).take(acting)
        with np.errstate(over="ignore"):  # the solver rejects such values
            single = offsets.astype(np.float32) + np.float32(0)  # as the engine reads it, and without -0
        digest = begun.copy()
        digest.update(single.tobytes())
        return digest.digest()

    def simulate(self, designs: Sequence[Design], record: Record) -> list[Outcome]:
        """Return the outcome of each design, in order.

        Raises:
            InputError: A design is not a body with a controller, or its record would be too large.
        """
        return simulate(self, designs, record)

    def duration_of(self, design: Design) -> float:
        """Return the time of the last step of a body, s; 0 without voxels.

        Raises:
            InputError: The design is not a body with a controller, or cannot be simulated.
        """
        check_design(design)
        material = design.roles[MORPHOLOGY]
        if not material.any():
            return 0.0
        try:
            clock = clock_of(self, material)
        except ValueError as error:  # the solver rejects the values of cells
            raise InputError(strip_body_index(error)) from error
        return clock.last(Record(()))

    def objective_for(self, designs: Sequence[Design]) -> dict[str, Any]:
        """Return the objective that fits bodies with these settings (see :mod:`.objectives`).

        Raises:
            InputError: A design is not a body with a controller.
        """
        for design in designs:
            check_design(design)
        return objective_of(self, (design.roles[MORPHOLOGY] for design in designs))

    def for_whole_designs(self) -> Self:
        """Return this simulator with ``whole_body``: a divergence anywhere counts."""
        return attrs.evolve(self, whole_body=True)

    def variants(self, design: Design, record: Record) -> list[Variant]:
        """Return the variants to which ``evoframe verify`` compares a design (see :mod:`.verification`).

        Raises:
            InputError: The design is not a body with a controller.
        """
        check_design(design)
        try:
            return [Variant(*change, *MEANINGS[change[0]]) for change in changes(self, design, record)]
        except ValueError as error:  # the solver rejects the values of cells
            raise InputError(strip_body_index(error)) from error

    def geometry(self, design: Design, frames: int) -> Geometry:
        """Return the surfaces of a body for drawing (see :mod:`.geometry`).

        Raises:
            InputError: The design is not a body with a controller, or has no voxels.
            ValueError: *frames* is not positive.
        """
        return geometry_of(self, design, frames)

    def random_controller(self, design: Design, rng: np.random.Generator) -> Design:
        """Return the body with offsets drawn uniformly from [-2 pi, 2 pi) for every cell of its canvas.

        Empty and passive cells also receive offsets, so that all bodies of a canvas receive the same ones. As
        with any controller, ``phase_unit`` determines their unit.

        Raises:
            InputError: The design is not a body with a controller.
        """
        check_design(design)
        offsets = rng.uniform(-math.tau, math.tau, design.roles[MORPHOLOGY].shape)
        return design.with_role(CONTROLLER, offsets)

    def published(self) -> list[tuple[str, Design]]:
        """Return the labels and bodies of :mod:`.published`, with all offsets 0."""
        return [
            (label, Design({MORPHOLOGY: material, CONTROLLER: np.zeros(material.shape)}))
            for label, material in published_bodies().items()
        ]

    def read(self, path: Path) -> list[tuple[str, Design]]:
        """Return the labels and bodies of an ``.npz`` file, or of a ``.vxa``, ``.vxc`` or ``.vxd`` file.

        An ``.npz`` file contains ``material`` (``[X, Y, Z]`` or ``[N, X, Y, Z]``, codes of the palette) and
        ``phase_cycles`` of the same shape. The offsets of other files are not converted; ``phase_unit``
        determines their unit.

        Raises:
            InputError: The file cannot be read, or is of another kind.
        """
        materials = materials_of(self)
        if path.suffix.lower() in SUFFIXES:
            palette = [attrs.asdict(material) for material in materials.values()]
            contents = self.interpret(
                path, FileOptions(settings={"palette": palette, "duration": self.duration})
            )
            return list(contents.designs) if contents else []
        if path.suffix.lower() != ".npz":
            expected = ", ".join(f"*{suffix}" for suffix in SUFFIXES)
            raise InputError(f"expected a file named *.npz, {expected}", source=path)
        unit = 1.0 if self.phase_unit == "cycles" else math.tau
        return [
            (label, Design({MORPHOLOGY: material, CONTROLLER: phase_cycles * unit}))
            for label, material, phase_cycles in read_bodies(path, materials)
        ]

    @staticmethod
    def settings_of(path: Path) -> Mapping[str, Any] | None:
        """Return all options of a ``.vxa``, ``.vxc`` or ``.vxd`` file as TOML values; ``None`` for others.

        Raises:
            InputError: The file cannot be read, is of another kind, or uses features that vox lacks.
        """
        contents = Vox.interpret(path, FileOptions())
        return contents.settings if contents else None

    @staticmethod
    def interpret(path: Path, options: FileOptions) -> FileContents | None:
        """Return body and options of a ``.vxa``, ``.vxc`` or ``.vxd`` file; ``None`` for other files.

        Raises:
            InputError: The file cannot be read, is of another kind, uses features that vox lacks, does not
                say when its simulation ends, or means different things in different dialects.
            ConfigurationError: There is no such dialect, or the file has no base.
        """
        if path.suffix.lower() not in SUFFIXES:
            return None
        file = read_vxa(path, options.dialect, options.base, options.settings)
        with naming_source(path):
            settings = file.toml(options.settings)
            _check_palette(file.material, settings["palette"])
        design = Design({MORPHOLOGY: file.material, CONTROLLER: file.phase})
        return FileContents(((path.name, design),), settings, file.rules.dialect, file.notes)

    def export(self, design: Design, format: str) -> Export:  # noqa: A002 - the protocol's word
        """Return a design as a file in the format ``vxa``, with these settings, or ``npz``, without them.

        Raises:
            ConfigurationError: The format is unknown.
            InputError: The design cannot be simulated, or cannot be expressed in the format.
        """
        if format not in self.formats:
            raise ConfigurationError(f"unknown format '{format}'; formats of vox: {', '.join(self.formats)}")
        check_design(design)
        material, phase = design.roles[MORPHOLOGY], phase_cycles(self, design)
        check_codes(material, materials_of(self))
        acting = acting_codes(self)[material]
        if format == "npz":
            return Export(
                write_body(material, phase, acting), ("the settings (set them by --preset or --set)",)
            )
        return Export(write_vxa(self, material, phase, acting), left_out(self))

    def provenance(self) -> dict[str, str]:
        """Return the solver's kernel and the compiler that built it."""
        return {"libvox kernel": model_of(self, (1, 1, 1)).kernel, "libvox compiler": libvox.COMPILER}


def _check_palette(material: NDArray[np.uint8], tables: Sequence[Mapping[str, Any]]) -> None:
    """Reject a body with materials that are not in a palette, given as TOML values.

    Raises:
        InputError: A cell has an unknown code; names the code and the known ones.
    """
    try:
        palette = tuple(PaletteMaterial(**table) for table in tables)
    except (TypeError, ValueError):
        return  # an invalid override, which the core reports
    check_codes(material, materials_of(VoxSettings(palette=palette)))


@functools.lru_cache(maxsize=8)  # for bodies that are being paired with many controllers
def _begun_key(
    settings: VoxSettings, shape: tuple[int, ...], cells: bytes, record: Record
) -> tuple[hashlib.blake2b, NDArray[np.intp]]:
    """Return the digest of a body and a record, and the indices of the cells whose offsets have an effect."""
    digest = hashlib.blake2b(repr((shape, record)).encode(), digest_size=20)
    digest.update(cells)
    acting = acting_codes(settings).take(np.frombuffer(cells, np.uint8))
    return digest, np.flatnonzero(acting)
