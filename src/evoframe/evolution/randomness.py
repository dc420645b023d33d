"""Random streams: one per seed and name, independent of the order of their creation."""

from __future__ import annotations

import hashlib

import numpy as np

__all__ = ["stream"]


def stream(seed: int, name: str) -> np.random.Generator:
    """Return the random stream called *name* of a run with this *seed*.

    Args:
        seed: Seed of the run, not negative.
        name: Name, such as ``population/morphology``; different names give independent streams.
    """
    digest = hashlib.sha256(name.encode()).digest()
    key = tuple(int.from_bytes(digest[start : start + 4], "little") for start in range(0, 16, 4))
    return np.random.Generator(np.random.PCG64(np.random.SeedSequence(seed, spawn_key=key)))
