"""What can be recorded of a simulation."""

from __future__ import annotations

import math
from collections.abc import Iterable

import evoframe_libvox as libvox
from evoframe import ConfigurationError, InputError
from evoframe_simulators.vox.limits import MOST_RECORD_BYTES

__all__ = ["FURTHER", "POINTS", "check_room", "check_tracks", "shape_of"]

POINTS: tuple[libvox.Track, ...] = ("tip", "face", "body")
"""Each ``float64[samples, 3]``, m: the last voxel in cell order, and the mass-weighted means of the voxels
with the largest initial x and of all voxels."""

FURTHER: tuple[libvox.Track, ...] = ("voxels", "energy", "strain", "momentum")
"""``voxels``: ``float64[samples, X, Y, Z, 3]``, m, NaN in empty cells. ``energy``: ``[samples, 2]``, J,
strain energy of the bonds and kinetic energy. ``strain``: ``[samples, 2]``, the least and the greatest of the
bonds. ``momentum``: ``[samples, 6]``, kg m/s and, about the origin, kg m2/s."""

_WIDTHS = {"energy": 2, "strain": 2, "momentum": 6}


def shape_of(track: str, canvas: tuple[int, ...]) -> tuple[int, ...]:
    """Return the shape of one sample of a track."""
    return (*canvas, 3) if track == "voxels" else (_WIDTHS.get(track, 3),)


def check_tracks(tracks: Iterable[str]) -> None:
    """Refuse what cannot be recorded.

    Raises:
        ConfigurationError: Says what can.
    """
    for track in tracks:
        if track not in (*POINTS, *FURTHER):
            raise ConfigurationError(
                f"vox has no track '{track}'; points: {', '.join(POINTS)}; "
                f"further tracks: {', '.join(FURTHER)}"
            )


def check_room(tracks: Iterable[str], canvas: tuple[int, ...], samples: int) -> None:
    """Refuse a record that would not fit into the memory of most machines, before it is allocated.

    Raises:
        InputError: Says how large it would be, and what to do.
    """
    size = 8 * samples * sum(math.prod(shape_of(track, canvas)) for track in tracks)
    if size > MOST_RECORD_BYTES:
        raise InputError(
            f"{samples} samples of {', '.join(tracks)} would take {size / 2**30:.1f} GiB for one body, "
            f"at most {MOST_RECORD_BYTES / 2**30:.0f}; record fewer samples"
        )
