"""Hypothesis strategies for bodies, settings and samples of the voxel solver, and comparison of results."""

from __future__ import annotations

from typing import Any, get_args

import attrs
import numpy as np
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays
from numpy.typing import NDArray

from evoframe_libvox import FIX_ALL, Material, Model, Result, Settings, Track

Bytes = NDArray[np.uint8]
Floats = NDArray[np.float64]
Canvas = tuple[int, int, int]

EDGE = 0.05  # m
TRACKS: tuple[Track, ...] = get_args(Track)

# Materials with equal bonds, and materials with different bonds.
ALIKE = {1: Material(5e6, 0.35, 1e6, 0.0, 1.0, 0.5), 3: Material(5e6, 0.35, 1e6, 0.01, 1.0, 0.5)}
DIFFERENT = ALIKE | {3: Material(1e6, 0.2, 5e5, -0.02, 0.3, 0.1), 7: Material(2e7, 0.45, 3e6, 0.03, 0.1, 0.1)}


@attrs.frozen
class Case:
    """A body with a controller in a model.

    Attributes:
        palette: Code -> material.
        body: ``uint8[X, Y, Z]``, material codes.
        phase: ``float64[X, Y, Z]``, cycles.
        fixed: ``uint8[X, Y, Z]``, clamped degrees of freedom.
        options: Settings that are not those of :meth:`model`.
    """

    palette: dict[int, Material]
    body: Bytes
    phase: Floats
    fixed: Bytes
    options: dict[str, Any]

    def model(self, *, kernel: str | None = None, whole_body: bool = False, **changes: Any) -> Model:
        """Create the model; *changes* are settings."""
        options: dict[str, Any] = {
            "voxel_size": EDGE,
            "duration": 0.05,
            "temperature_amplitude": 14.4714242553,
            "period": 0.25,
        }
        x, y, z = self.body.shape
        settings = Settings(**(options | self.options | changes))
        return Model((x, y, z), self.palette, settings, self.fixed, kernel=kernel, whole_body=whole_body)

    def steps(self) -> int:
        return int(self.model().time_steps(self.body[None])[1][0])

    def simulate(self, samples: list[int] | range, tracks: tuple[Track, ...] = TRACKS, **how: Any) -> Result:
        """Simulate the body in a new model."""
        return self.model(**how).simulate(self.body[None], self.phase[None], samples, tracks)


# ---- strategies


def bodies(
    codes: list[int], longest: Canvas = (7, 5, 5), shortest: Canvas = (1, 1, 1)
) -> st.SearchStrategy[tuple[Bytes, Floats, Bytes]]:
    """Draw materials, phases in cycles and fixed degrees of freedom as arrays over one canvas."""
    return _bodies(codes, longest, shortest)


@st.composite
def _bodies(
    draw: st.DrawFn, codes: list[int], longest: Canvas, shortest: Canvas
) -> tuple[Bytes, Floats, Bytes]:
    canvas = draw(st.tuples(*map(st.integers, shortest, longest)))
    body = draw(arrays.arrays(np.uint8, canvas, elements=st.sampled_from([0, *codes, *codes])))
    body[-1, 0, 0] = codes[0]
    cycles = st.integers(-40, 40).map(lambda n: n / 16)
    phase = draw(arrays.arrays(np.float64, canvas, elements=cycles))
    held = draw(st.sampled_from(["nothing", "slab", "in part"]))
    fixed = np.zeros(canvas, np.uint8)
    if held == "slab":
        fixed[0] = FIX_ALL
    elif held == "in part":
        fixed = draw(arrays.arrays(np.uint8, canvas, elements=st.sampled_from([0, 0, 0, 4, 7, 56, 63])))
    return body, phase, fixed


SURROUNDINGS: dict[str, st.SearchStrategy[Any]] = {
    "gravity": st.sampled_from([-9.81, 2.0]),
    "floor": st.booleans(),
    "floor_slope": st.sampled_from([0.0, 5.0]),
    "fluid_drag": st.sampled_from([0.0, 700.0]),
    "fluid_by_size": st.booleans(),
    "falling_code": st.sampled_from([0, 1]),
    "smallest_size": st.sampled_from([0.1, 0.95]),
    "largest_size": st.sampled_from([1.0, 1.05, 3.0]),
    "size_clamp": st.booleans(),
    "start_time": st.sampled_from([0.0, 0.01]),
    "ramp": st.sampled_from([0.0, 0.02]),
    "substeps": st.sampled_from([1, 2]),
    "bond_damping": st.sampled_from([0.2, 1.0]),
    "slow_damping": st.sampled_from([0.0, 0.05]),
    "contact_damping": st.sampled_from([0.0, 0.5]),
    "contact_friction": st.booleans(),
    "complete_contacts": st.booleans(),
    "self_collision": st.booleans(),
    "collision_horizon": st.sampled_from([1.3, 2.0, 3.0]),
    "temperature_amplitude": st.sampled_from([5.0, 14.4714242553]),
}

# Larger strains and other contacts, without what requires the whole body.
CONTACTS: dict[str, st.SearchStrategy[Any]] = {
    name: drawn
    for name, drawn in SURROUNDINGS.items()
    if name not in {"fluid_drag", "fluid_by_size", "contact_damping", "contact_friction", "self_collision"}
} | {
    "self_collision": st.sampled_from([True, True, True, False]),
    "collision_envelope": st.sampled_from([1.0, 1.2, 1.5, 2.0]),
    "collision_list_factor": st.sampled_from([1.0, 1.5, 2.0]),
    "temperature_amplitude": st.sampled_from([5.0, 14.4714242553, 50.0, 150.0]),
    "period": st.sampled_from([0.02, 0.05, 0.25, 1.0]),
    "largest_distance": st.sampled_from([100.0, 1e9]),
}


def cases(
    settings: dict[str, st.SearchStrategy[Any]] | None = None,
    longest: Canvas = (7, 5, 5),
    shortest: Canvas = (1, 1, 1),
) -> st.SearchStrategy[Case]:
    """Draw a body with optional *settings*, which are :data:`SURROUNDINGS` by default."""
    options = st.fixed_dictionaries({}, optional=SURROUNDINGS if settings is None else settings)
    return st.one_of(
        *(
            st.builds(_case, st.just(palette), bodies(codes, longest, shortest), options)
            for palette, codes in ((ALIKE, [1, 3]), (DIFFERENT, [1, 3, 7]))
        )
    )


def _case(
    palette: dict[int, Material], arrays_of: tuple[Bytes, Floats, Bytes], options: dict[str, Any]
) -> Case:
    return Case(palette, *arrays_of, options)


# ---- comparison


def assert_same(a: Result, b: Result) -> None:
    """Check that two results are equal, bit for bit."""
    assert np.array_equal(a.diverged_step, b.diverged_step)
    assert a.tracks.keys() == b.tracks.keys()
    for track, values in a.tracks.items():
        assert np.array_equal(values, b.tracks[track], equal_nan=True), track


def assert_same_as_whole(usual: Result, whole: Result, samples: list[int]) -> None:
    """Check that a body has the bits of the whole one in all samples before the whole one diverges."""
    at, end = int(usual.diverged_step[0]), int(whole.diverged_step[0])
    assert at == 0 or 0 < end <= at
    before = len(samples) if end == 0 else int(np.searchsorted(samples, end))
    for track, values in usual.tracks.items():
        assert np.array_equal(values[0, :before], whole.tracks[track][0, :before], equal_nan=True), track
