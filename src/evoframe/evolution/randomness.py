"""Random streams: one seed, one stream for each name, whatever the order in which they are made."""

from __future__ import annotations

import hashlib

import numpy as np

__all__ = ["stream"]


def stream(seed: int, name: str) -> np.random.Generator:
    """Return the stream that belongs to *name* in a run with this *seed*.

    Args:
        seed: The run's seed, not negative.
        name: Such as ``population/morphology``; different names give independent streams.
    """
    digest = hashlib.sha256(name.encode()).digest()
    key = tuple(int.from_bytes(digest[start : start + 4], "little") for start in range(0, 16, 4))
    return np.random.Generator(np.random.PCG64(np.random.SeedSequence(seed, spawn_key=key)))
