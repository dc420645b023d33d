"""The simulator ``vox``: bodies of voxels, held or free, whose contractile voxels swing."""

from __future__ import annotations

import functools
import hashlib
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, ClassVar

import attrs
import numpy as np

import evoframe_libvox as libvox
from evoframe import (
    CONTROLLER,
    MORPHOLOGY,
    ConfigurationError,
    Design,
    Export,
    Geometry,
    InputError,
    Outcome,
    Record,
    Variant,
)
from evoframe_simulators.files import naming
from evoframe_simulators.vox.bodies import check_codes, check_design, read_bodies
from evoframe_simulators.vox.geometry import geometry_of
from evoframe_simulators.vox.models import acting_codes, model_of, possible_clocks, without_number
from evoframe_simulators.vox.published import published_bodies
from evoframe_simulators.vox.sampling import check_samples
from evoframe_simulators.vox.settings import VoxSettings, materials_of, phase_cycles
from evoframe_simulators.vox.simulation import simulate
from evoframe_simulators.vox.tracks import POINTS, check_tracks
from evoframe_simulators.vox.verification import changes
from evoframe_simulators.vox.vxa import left_out, read_vxa, write_vxa

__all__ = ["Vox"]


@attrs.frozen(cache_hash=True)  # models and clocks are looked up by it
class Vox(VoxSettings):
    """Voxels on libvox; the defaults are the paper's (paper.md, "The simulation of one pair").

    The whole slab x = 0 of the canvas is clamped in all six degrees of freedom, and there is neither gravity
    nor floor. A design without any voxel cannot be simulated and counts as diverged at step 0. Beside its
    points it records ``voxels``, ``energy``, ``strain`` and ``momentum``: see
    ``evoframe_simulators.vox.tracks``. Its options are the fields of
    :class:`~evoframe_simulators.vox.settings.VoxSettings`.
    """

    requires: ClassVar[tuple[str, ...]] = (MORPHOLOGY, CONTROLLER)
    tracks: ClassVar[tuple[libvox.Track, ...]] = POINTS
    formats: ClassVar[tuple[str, ...]] = ("vxa",)

    def __attrs_post_init__(self) -> None:
        possible_clocks(self)  # the solver has the last word on what it can do with these settings

    def check(self, record: Record) -> None:
        """Refuse a record with a track or a sample that there will not be, or that ends too early.

        Raises:
            ConfigurationError: Says what there is.
        """
        check_tracks(record.tracks)
        check_samples(record, possible_clocks(self), self.duration)

    def key(self, design: Design, record: Record) -> bytes:
        """Return a digest of the body, the offsets that act, and the record.

        Raises:
            InputError: The design is no body with a controller.
        """
        check_design(design)
        material, phase = design.roles[MORPHOLOGY], phase_cycles(self, design)
        acting = phase[acting_codes(self).take(material)]
        with np.errstate(over="ignore"):  # left to the solver to refuse
            single = acting.astype(np.float32) + np.float32(0)  # as the engine reads it, and without -0
        digest = hashlib.blake2b(_written(material.shape, record), digest_size=20)
        digest.update(material.tobytes())
        digest.update(single.tobytes())
        return digest.digest()

    def simulate(self, designs: Sequence[Design], record: Record) -> list[Outcome]:
        """Return the outcome of each design, in order.

        Raises:
            InputError: A design is no body with a controller, or its record would be too large.
        """
        return simulate(self, designs, record)

    def variants(self, design: Design, record: Record) -> list[Variant]:
        """Return what ``evoframe verify`` compares a design with (see :mod:`.verification`).

        Raises:
            InputError: The design is no body with a controller.
        """
        check_design(design)
        try:
            return [Variant(*change) for change in changes(self, design, record)]
        except ValueError as error:  # the solver's words for what cells hold
            raise InputError(without_number(error)) from error

    def geometry(self, design: Design, frames: int) -> Geometry:
        """Return what is drawn of a body (see :mod:`.geometry`).

        Raises:
            InputError: The design is no body with a controller, or has no voxel.
            ValueError: *frames* is not positive.
        """
        return geometry_of(self, design, frames)

    def random_controller(self, design: Design, rng: np.random.Generator) -> Design:
        """Return the body with offsets drawn from [-2 pi, 2 pi), uniformly, for every cell of its canvas.

        Cells that are empty or do not act have offsets too, so that all bodies of a canvas get the same. As
        with any controller, ``phase_unit`` says how they are read.

        Raises:
            InputError: The design is no body with a controller.
        """
        check_design(design)
        offsets = rng.uniform(-math.tau, math.tau, design.roles[MORPHOLOGY].shape)
        return design.with_role(CONTROLLER, offsets)

    def published(self) -> list[tuple[str, Design]]:
        """Return the bodies of :mod:`.published` with their labels, all offsets being 0."""
        return [
            (label, Design({MORPHOLOGY: material, CONTROLLER: np.zeros(material.shape)}))
            for label, material in published_bodies().items()
        ]

    def read(self, path: Path) -> list[tuple[str, Design]]:
        """Return the bodies of an ``.npz`` or ``.vxa`` file with their labels.

        An ``.npz`` file has ``material`` (``[X, Y, Z]`` or ``[N, X, Y, Z]``, codes of the palette) and
        ``phase_cycles`` of the same shape. The offsets of a ``.vxa`` file are taken as they stand there, so
        that ``phase_unit`` says how they are read.

        Raises:
            InputError: The file cannot be read, or is something else.
        """
        materials = materials_of(self)
        if path.suffix.lower() == ".vxa":
            file = read_vxa(path)
            with naming(path):
                check_codes(file.material, materials)
            return [(path.name, Design({MORPHOLOGY: file.material, CONTROLLER: file.phase}))]
        if path.suffix.lower() != ".npz":
            raise InputError(f"{path}: vox reads .npz and .vxa files, and this is neither by its name")
        unit = 1.0 if self.phase_unit == "cycles" else math.tau
        return [
            (label, Design({MORPHOLOGY: material, CONTROLLER: phase_cycles * unit}))
            for label, material, phase_cycles in read_bodies(path, materials)
        ]

    @staticmethod
    def settings_of(path: Path) -> Mapping[str, Any] | None:
        """Return all options as a ``.vxa`` file has them, as TOML values; ``None`` for other files.

        Raises:
            InputError: The file cannot be read, is no such file, or asks for what vox does not do; says what.
        """
        if path.suffix.lower() != ".vxa":
            return None
        file = read_vxa(path)
        with naming(path):
            settings = file.settings()
        # TOML has lists for tuples.
        return attrs.asdict(
            settings, value_serializer=lambda _, __, value: list(value) if isinstance(value, tuple) else value
        )

    def export(self, design: Design, format: str) -> Export:  # noqa: A002 - the protocol's word
        """Return a design with these settings as a file of the format ``vxa``.

        Raises:
            ConfigurationError: There is no such format.
            InputError: The design cannot be simulated, or has what the format cannot say.
        """
        if format not in self.formats:
            raise ConfigurationError(f"vox does not write '{format}'; formats: {', '.join(self.formats)}")
        check_design(design)
        material, phase = design.roles[MORPHOLOGY], phase_cycles(self, design)
        acting = acting_codes(self)[material]
        check_codes(material, materials_of(self))
        return Export(write_vxa(self, material, phase, acting), left_out(self))

    def provenance(self) -> dict[str, str]:
        """Return the kernel that computes, and the compiler that made it."""
        return {"libvox kernel": model_of(self, (1, 1, 1)).kernel, "libvox compiler": libvox.COMPILER}


@functools.lru_cache(maxsize=16)
def _written(shape: tuple[int, ...], record: Record) -> bytes:
    """Return in bytes what a key says beside what stands in the cells."""
    return repr((shape, record)).encode()
