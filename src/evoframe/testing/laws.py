"""Functions that the contracts share: testing a law with many examples, and comparisons to the last bit."""

from __future__ import annotations

import functools
import math
import random
import re
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any

import numpy as np
from hypothesis import HealthCheck, given, settings, strategies as st
from hypothesis.strategies import SearchStrategy

from evoframe.contract import GeometryPart, Network, Outcome
from evoframe.errors import ConfigurationError

__all__ = [
    "JUNK",
    "accepted",
    "assert_is_mesh",
    "at_most",
    "damaged_at",
    "for_all",
    "global_random_state_untouched",
    "places_in",
    "random_network",
    "refusal",
    "same_arrays",
    "same_bits",
    "same_outcome",
]

TOLERANCE = 1e-12

_MISSING: Any = object()
JUNK: SearchStrategy[Any] = st.one_of(
    st.sampled_from([None, True, -1, 0, 2, 10**400, math.nan, math.inf, "", "sin", [], {}, [[]], [{}]]),
    st.floats(),
    st.just(_MISSING),
)
"""Values that a damaged document may contain; one of them removes the place instead."""


def for_all(law: Callable[..., None], limit: int | None = None, /, **strategies: SearchStrategy[Any]) -> None:
    """Test *law* with examples of its arguments, by default as many as the profile of hypothesis states.

    The law is a function inside a test, not a decorated method, because a method decorated by hypothesis
    belongs to one class, while these tests are inherited by many. It can also use attributes of the subclass.
    There is no time limit, since neither a slow component nor a slow computer breaks a law.
    """
    untimed = settings(deadline=None, suppress_health_check=[HealthCheck.too_slow])
    limited = settings(untimed, max_examples=limit) if limit else untimed
    limited(given(**strategies)(law))()


def places_in(value: Any) -> Iterator[tuple[Any, ...]]:
    """Yield the paths of *value* itself and of all JSON values within it."""
    yield ()
    if isinstance(value, dict | list):
        for key in value if isinstance(value, dict) else range(len(value)):
            yield from ((key, *rest) for rest in places_in(value[key]))


def damaged_at(place: tuple[Any, ...], value: Any, junk: Any) -> Any:
    """Return *value*, which is changed, with an example of :data:`JUNK` at a *place*."""
    if not place:
        return None if junk is _MISSING else junk
    parent = functools.reduce(lambda within, key: within[key], place[:-1], value)
    if junk is _MISSING:
        del parent[place[-1]]
    else:
        parent[place[-1]] = junk
    return value


def at_most(smaller: float, larger: float) -> bool:
    """Return whether *smaller* <= *larger*, with a relative tolerance of 1e-12.

    Differences below the smallest normal number are ignored, since such floats have no relative precision.
    """
    slack = TOLERANCE * max(abs(smaller), abs(larger))
    return smaller <= larger + max(slack, sys.float_info.min)


def same_bits(one: Any, other: Any) -> bool:
    """Return whether two arrays agree in shape, type and every bit; a NaN equals itself."""
    one, other = np.asarray(one), np.asarray(other)
    return bool(one.shape == other.shape and one.dtype == other.dtype and one.tobytes() == other.tobytes())


def same_outcome(one: Outcome, other: Outcome) -> bool:
    """Return whether two outcomes agree in every bit."""
    return (
        one.diverged_at == other.diverged_at
        and same_bits(one.steps, other.steps)
        and same_bits(one.times, other.times)
        and same_arrays(one.tracks, other.tracks)
    )


def same_arrays(one: Mapping[str, Any], other: Mapping[str, Any]) -> bool:
    """Return whether two mappings have the same names and, for each name, the same bits."""
    return set(one) == set(other) and all(same_bits(one[name], other[name]) for name in one)


def accepted(check: Callable[[int], object], numbers: range) -> list[int]:
    """Return the *numbers* that *check* accepts."""
    return [number for number in numbers if refusal(check, number) is None]


def refusal(check: Callable[[int], object], number: int) -> str | None:
    """Return the message with which *check* refuses *number*, or ``None`` if it accepts it.

    Only a :class:`ConfigurationError` is a refusal; any other exception is a bug and propagates.
    """
    try:
        check(number)
    except ConfigurationError as error:
        return str(error)
    return None


@contextmanager
def global_random_state_untouched() -> Iterator[None]:
    """Assert that the global random generators of Python and numpy are neither used nor seeded."""
    before = random.getstate(), _numpy_state()
    yield
    use_own = "draw from the generator that is passed to the component only"
    assert random.getstate() == before[0], f"Python's global random state was changed; {use_own}"
    assert _numpy_state() == before[1], f"numpy's global random state was changed; {use_own}"


def _numpy_state() -> list[str]:
    state = np.random.get_state(legacy=False)  # noqa: NPY002 - to check that it is not used
    return [repr(state[key]) for key in sorted(state)] + [state["state"]["key"].tobytes().hex()]


def random_network(inputs: int, outputs: int, seed: int, scale: float) -> Network:
    """Return a network with random weights whose outputs reach about *scale*.

    It asserts that its points have the shape and type that encoders must pass to networks.
    """
    rng = np.random.default_rng(seed)
    weights, bias = rng.normal(size=(inputs, outputs)), rng.normal(size=outputs)

    def network(points: np.ndarray[Any, np.dtype[np.float64]]) -> np.ndarray[Any, np.dtype[np.float64]]:
        assert points.dtype == np.float64, f"a network requires float64 points, found {points.dtype}"
        assert points.ndim == 2, f"a network requires points of shape (n, {inputs}), found {points.shape}"
        assert points.shape[1] == inputs, (
            f"a network requires points of shape (n, {inputs}), found {points.shape}"
        )
        assert np.isfinite(points).all(), "a network requires finite points"
        return scale * np.sin(points @ weights + bias)

    return network


def assert_is_mesh(part: GeometryPart, frames: int) -> None:
    """Assert that a part of a geometry can be drawn: it has faces, and finite corners in every frame."""
    assert part.name.strip(), "a part requires a name that is not empty"
    assert re.fullmatch("#[0-9a-fA-F]{6}", part.colour), (
        f"{part.name}: expected a color like #0072b2, found '{part.colour}'"
    )
    assert 0.0 < part.opacity <= 1.0, f"{part.name}: expected 0 < opacity <= 1, found {part.opacity}"
    count = part.vertices.shape[1]
    assert part.vertices.shape == (frames, count, 3), (
        f"{part.name}: expected vertices of shape ({frames}, n, 3), found {part.vertices.shape}"
    )
    assert np.isfinite(part.vertices).all(), f"{part.name}: expected finite vertices"
    assert part.faces.dtype == np.int64, f"{part.name}: expected int64 faces, found {part.faces.dtype}"
    assert part.faces.ndim == 2, f"{part.name}: expected faces of shape (n, 4), found {part.faces.shape}"
    assert part.faces.shape[1] == 4, f"{part.name}: expected faces of shape (n, 4), found {part.faces.shape}"
    assert len(part.faces) > 0, f"{part.name}: expected at least one face, found none"
    assert part.faces.min() >= 0, f"{part.name}: expected indices of vertices, found {part.faces.min()}"
    assert part.faces.max() < count, (
        f"{part.name}: expected indices below the {count} vertices, found {part.faces.max()}"
    )
