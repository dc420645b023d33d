"""Private random streams for a library that draws from Python's global stream."""

from __future__ import annotations

import random
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import ModuleType
from typing import Any, TypeAlias

import neat
import numpy as np

__all__ = ["PrivateStream"]

_GLOBAL: Any = random.random.__self__  # type: ignore[attr-defined] # the generator of the module's functions

_Use: TypeAlias = tuple[ModuleType, str, Callable[[random.Random], Any]]
"""A module, a name in it that stands for the global stream, and what stands for another generator."""


def _uses_of_the_global_stream() -> Iterator[_Use]:
    """Yield the names in neat-python's modules that are the module :mod:`random`, or its functions."""
    for path, module in list(sys.modules.items()):
        if path.partition(".")[0] != neat.__name__:
            continue
        for name, value in vars(module).items():
            if value is random:
                yield module, name, lambda generator: generator
            elif getattr(value, "__self__", None) is _GLOBAL:
                yield module, name, _method(value.__name__)


def _method(name: str) -> Callable[[random.Random], Any]:
    return lambda generator: getattr(generator, name)


_USES = list(_uses_of_the_global_stream())
_ORIGINALS = [vars(module)[name] for module, name, _ in _USES]
_REPLACED = threading.Lock()
"""Lock of the names in neat-python's modules, which only one population at a time can replace."""


class PrivateStream:
    """A Mersenne Twister of one population.

    Within :meth:`swapped_in`, neat-python draws from it, instead of from the functions of the module
    :mod:`random`. The global stream does not change, and simulations in other threads can use it.
    """

    def __init__(self, rng: np.random.Generator) -> None:
        """Seed the stream with one draw from *rng*."""
        seed = int.from_bytes(rng.bytes(32), "little")
        self._twister = random.Random(seed)  # noqa: S311 - evolution, not cryptography

    @contextmanager
    def swapped_in(self) -> Iterator[random.Random]:
        """Make neat-python draw from this stream; the context is its generator."""
        with _REPLACED:
            try:
                for module, name, of in _USES:
                    setattr(module, name, of(self._twister))
                yield self._twister
            finally:
                for (module, name, _), original in zip(_USES, _ORIGINALS, strict=True):
                    setattr(module, name, original)

    def state(self) -> Any:
        """Return the state as JSON values."""
        version, internal, next_gauss = self._twister.getstate()
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
        self._twister = twister
