"""What the contracts have in common: running a law on many examples, and comparing to the last bit."""

from __future__ import annotations

import random
import re
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any

import numpy as np
from hypothesis import HealthCheck, given, settings
from hypothesis.strategies import SearchStrategy

from evoframe.contract import GeometryPart, Network, Outcome
from evoframe.errors import ConfigurationError

__all__ = [
    "accepted",
    "assert_is_mesh",
    "at_most",
    "for_all",
    "global_random_state_untouched",
    "random_network",
    "refusal",
    "same_arrays",
    "same_bits",
    "same_outcome",
]

TOLERANCE = 1e-12


def for_all(law: Callable[..., None], /, **strategies: SearchStrategy[Any]) -> None:
    """Run *law* on examples of its arguments.

    The law is a function within a test, not a decorated method: what hypothesis has decorated belongs
    to one class, while these are inherited by many. It may use what its subclass declares, too. Neither the
    speed of a component nor that of the computer is a law, so nothing here is timed.
    """
    untimed = settings(deadline=None, suppress_health_check=[HealthCheck.too_slow])
    untimed(given(**strategies)(law))()


def at_most(smaller: float, larger: float) -> bool:
    """Say whether *smaller* <= *larger*, to a relative 1e-12.

    Below the smallest normal number a float has no relative precision: such a difference is none.
    """
    slack = TOLERANCE * max(abs(smaller), abs(larger))
    return smaller <= larger + max(slack, sys.float_info.min)


def same_bits(one: Any, other: Any) -> bool:
    """Say whether two arrays agree in shape, type and every bit; a NaN equals itself."""
    one, other = np.asarray(one), np.asarray(other)
    return bool(one.shape == other.shape and one.dtype == other.dtype and one.tobytes() == other.tobytes())


def same_outcome(one: Outcome, other: Outcome) -> bool:
    """Say whether two outcomes agree in every bit."""
    return (
        one.diverged_at == other.diverged_at
        and same_bits(one.steps, other.steps)
        and same_bits(one.times, other.times)
        and same_arrays(one.tracks, other.tracks)
    )


def same_arrays(one: Mapping[str, Any], other: Mapping[str, Any]) -> bool:
    """Say whether two mappings have the same names and, for each, the same bits."""
    return set(one) == set(other) and all(same_bits(one[name], other[name]) for name in one)


def accepted(check: Callable[[int], object], numbers: range) -> list[int]:
    """Return those of *numbers* that *check* does not refuse."""
    return [number for number in numbers if refusal(check, number) is None]


def refusal(check: Callable[[int], object], number: int) -> str | None:
    """Return the message with which *check* refuses *number*, or ``None`` if it does not.

    Only a :class:`ConfigurationError` is a refusal; any other exception is a fault and passes.
    """
    try:
        check(number)
    except ConfigurationError as error:
        return str(error)
    return None


@contextmanager
def global_random_state_untouched() -> Iterator[None]:
    """Make sure that nobody draws from, or seeds, the generators that all code shares."""
    before = random.getstate(), _numpy_state()
    yield
    assert random.getstate() == before[0], "Python's global random state was changed"
    assert _numpy_state() == before[1], "numpy's global random state was changed"


def _numpy_state() -> list[str]:
    state = np.random.get_state(legacy=False)  # noqa: NPY002 - to see that nobody uses it
    return [repr(state[key]) for key in sorted(state)] + [state["state"]["key"].tobytes().hex()]


def random_network(inputs: int, outputs: int, seed: int, scale: float) -> Network:
    """Return a network with random weights whose outputs reach up to about *scale*.

    It refuses points of another shape or type than a network is promised.
    """
    rng = np.random.default_rng(seed)
    weights, bias = rng.normal(size=(inputs, outputs)), rng.normal(size=outputs)

    def network(points: np.ndarray[Any, np.dtype[np.float64]]) -> np.ndarray[Any, np.dtype[np.float64]]:
        assert points.dtype == np.float64, f"a network takes float64, not {points.dtype}"
        assert points.ndim == 2, f"a network takes float64[n, {inputs}], not {points.shape}"
        assert points.shape[1] == inputs, f"a network takes float64[n, {inputs}], not {points.shape}"
        assert np.isfinite(points).all(), "a network takes finite points"
        return scale * np.sin(points @ weights + bias)

    return network


def assert_is_mesh(part: GeometryPart, frames: int) -> None:
    """Assert that a part of a geometry can be drawn: it has faces, and all their corners at each time."""
    assert part.name.strip(), "a part needs a name"
    assert re.fullmatch("#[0-9a-fA-F]{6}", part.colour), f"'{part.colour}' is no colour like #0072b2"
    assert 0.0 < part.opacity <= 1.0
    count = part.vertices.shape[1]
    assert part.vertices.shape == (frames, count, 3)
    assert np.isfinite(part.vertices).all()
    assert part.faces.dtype == np.int64
    assert part.faces.ndim == 2
    assert part.faces.shape[1] == 4
    assert len(part.faces) > 0, f"there is nothing to see of {part.name}"
    assert part.faces.min() >= 0
    assert part.faces.max() < count
