"""Tracks that a simulation can record."""

from __future__ import annotations

import math
from collections.abc import Iterable

import evoframe_libvox as libvox
from evoframe import ConfigurationError, InputError
from evoframe_simulators.vox.limits import MOST_RECORD_BYTES

__all__ = ["FURTHER", "POINTS", "check_size", "check_tracks", "shape_of"]

POINTS: tuple[libvox.Track, ...] = ("tip", "face", "body")
"""Positions ``float64[samples, 3]``, m: of the last voxel in cell order, and the mass-weighted means of the
voxels with the largest initial x and of all voxels."""

FURTHER: tuple[libvox.Track, ...] = ("voxels", "energy", "strain", "momentum")
"""``voxels``: positions ``float64[samples, X, Y, Z, 3]``, m, NaN in empty cells. ``energy``:
``[samples, 2]``, strain energy of the bonds and kinetic energy, J. ``strain``: ``[samples, 2]``, smallest and
largest strain of a bond. ``momentum``: ``[samples, 6]``, linear, kg m/s, and angular about the origin,
kg m2/s."""

_WIDTHS = {"energy": 2, "strain": 2, "momentum": 6}


def shape_of(track: str, canvas: tuple[int, ...]) -> tuple[int, ...]:
    """Return the shape of one sample of a track."""
    return (*canvas, 3) if track == "voxels" else (_WIDTHS.get(track, 3),)


def check_tracks(tracks: Iterable[str]) -> None:
    """Reject unknown tracks.

    Raises:
        ConfigurationError: A track is unknown; names the available ones.
    """
    for track in tracks:
        if track not in (*POINTS, *FURTHER):
            raise ConfigurationError(
                f"unknown track '{track}'; points: {', '.join(POINTS)}; other tracks: {', '.join(FURTHER)}"
            )


def check_size(tracks: Iterable[str], canvas: tuple[int, ...], samples: int) -> None:
    """Reject a record that exceeds the memory of most machines, before it is allocated.

    Raises:
        InputError: The record is too large.
    """
    size = 8 * samples * sum(math.prod(shape_of(track, canvas)) for track in tracks)
    if size > MOST_RECORD_BYTES:
        raise InputError(
            f"{samples} samples of {', '.join(tracks)} require {size / 2**30:.1f} GiB for one body, "
            f"expected at most {MOST_RECORD_BYTES / 2**30:.0f} GiB; record fewer samples"
        )
