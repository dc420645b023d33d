"""Private random streams for a library that draws from Python's global stream."""

from __future__ import annotations

import random
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np

__all__ = ["PrivateStream"]

_GLOBAL_RANDOM = threading.Lock()
"""Lock of the global stream, which only one population at a time can replace by its own."""


class PrivateStream:
    """State of Python's Mersenne Twister that belongs to one population.

    neat-python calls the functions of the module :mod:`random`. Within :meth:`swapped_in`, they draw from
    this stream; afterwards the global stream continues unchanged.
    """

    def __init__(self, rng: np.random.Generator) -> None:
        """Seed the stream with one draw from *rng*."""
        seed = int.from_bytes(rng.bytes(32), "little")
        self._state = random.Random(seed).getstate()  # noqa: S311 - evolution, not cryptography

    @contextmanager
    def swapped_in(self) -> Iterator[None]:
        """Make the module :mod:`random` draw from this stream."""
        with _GLOBAL_RANDOM:
            outside = random.getstate()
            random.setstate(self._state)
            try:
                yield
            finally:
                self._state = random.getstate()
                random.setstate(outside)

    def state(self) -> Any:
        """Return the state as JSON values."""
        version, internal, next_gauss = self._state
        return [version, list(internal), next_gauss]

    def restore(self, state: Any) -> None:
        """Continue from the result of :meth:`state`.

        Raises:
            ValueError: *state* is not such a state; this stream is unchanged.
        """
        twister = random.Random()  # noqa: S311 - evolution, not cryptography
        try:
            version, internal, next_gauss = state
            twister.setstate((version, tuple(internal), None if next_gauss is None else float(next_gauss)))
        except (OverflowError, TypeError, ValueError) as error:
            raise ValueError(f"state.pool.random: expected the state of a random stream: {error}") from error
        self._state = twister.getstate()
