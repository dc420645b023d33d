"""The voxel solver from Python: NumPy arrays in, NumPy arrays out.

Arrays over a canvas are indexed ``[x, y, z]``. Units are metre, second, kilogram, pascal and degree; phases
are in cycles. The solver itself is the C library in ``libvox/``: it checks the values of all arguments,
releases the GIL while it works, and keeps no state but memory to be used again, so threads may share a model.
"""

import itertools
import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import Any, Final, Literal, get_args

import attrs
import numpy as np
from numpy.typing import ArrayLike, NDArray

from evoframe_libvox._vox import ffi, lib

__all__ = [
    "COMPILER",
    "FIX_ALL",
    "KERNELS",
    "PROPERTY_RANGES",
    "SETTING_RANGES",
    "VERSION",
    "Material",
    "Model",
    "Range",
    "Result",
    "Settings",
    "Track",
]


def _kernels() -> Iterator[tuple[str, int]]:
    for number in itertools.count(1):
        name = lib.vox_kernel_name(number)
        if name == ffi.NULL:
            return
        if found := ffi.string(name).decode():
            yield found, number


_NUMBERS: Final = dict(_kernels())

KERNELS: Final = tuple(_NUMBERS)
"""Names of what can compute on this processor, the fastest last. ``scalar`` is the reference, one
bond after the other. The others are one program for several instruction sets, with the same bits."""

VERSION: Final[str] = ffi.string(lib.vox_version()).decode()
"""Version of the library; its second number rises with whatever changes its interface or a bit of the
results."""

COMPILER: Final[str] = ffi.string(lib.vox_compiler()).decode()
"""Name and version of the compiler that made the library."""

FIX_ALL: Final = 63
"""All six degrees of freedom of a voxel: bits 1, 2, 4 for its position along x, y, z, and 8, 16, 32 for its
rotation about them."""


@attrs.frozen
class Range:
    """What a setting, or a property of a material, may be; ``x in range`` checks a number.

    Attributes:
        lower: Lower bound, in the unit of the setting; ``-inf`` if there is none.
        upper: Upper bound; ``inf`` if there is none.
        lower_included: Whether the lower bound itself is allowed; never if it is infinite.
        upper_included: Whether the upper bound itself is allowed.
        whole: Whether only whole numbers are allowed.
        words: What a number must be, such as ``above 0 and at most 1e9 s``.
    """

    lower: float
    upper: float
    lower_included: bool
    upper_included: bool
    whole: bool
    words: str

    def __contains__(self, number: float) -> bool:
        above = number >= self.lower if self.lower_included else number > self.lower
        below = number <= self.upper if self.upper_included else number < self.upper
        return above and below and (not self.whole or number == int(number))


def _ranges(nth: Callable[[int], Any]) -> Mapping[str, Range]:
    """Return the ranges that the library lists, by the name of the field."""
    ranges = {}
    for number in itertools.count():
        found = nth(number)
        if found == ffi.NULL:
            break
        ranges[ffi.string(found.name).decode()] = Range(
            lower=found.lower,
            upper=found.upper,
            lower_included=bool(found.lower_included),
            upper_included=bool(found.upper_included),
            whole=bool(found.whole),
            words=ffi.string(found.words).decode(),
        )
    return MappingProxyType(ranges)


SETTING_RANGES: Final = _ranges(lib.vox_setting_range)
"""Range of each number in :class:`Settings`; numbers outside are refused when a model is made."""

PROPERTY_RANGES: Final = _ranges(lib.vox_property_range)
"""Range of each number in :class:`Material`. An expansion must also be finite when multiplied by the
temperature's amplitude."""

Track = Literal["tip", "face", "body", "voxels", "energy", "strain", "momentum"]


_ROUNDING: Final = 1e-12  # relative; a time that is a multiple of the time step is met, not missed


@attrs.frozen
class Material:
    """What a voxel is made of.

    Attributes:
        youngs_modulus: Pa; 1e-6 to 1e18.
        poisson_ratio: At least 0, below 0.5. It acts on the twist of bonds only.
        density: kg/m3; 1e-6 to 1e18.
        expansion: Linear thermal expansion per degree; 0 for a passive material, negative for one that
            contracts when the others expand.
        static_friction: Share of the floor's push up to which a voxel that rests on it sticks.
        dynamic_friction: Share of the push that brakes a voxel which slides on the floor or on another.
    """

    youngs_modulus: float
    poisson_ratio: float
    density: float
    expansion: float
    static_friction: float = 0.0
    dynamic_friction: float = 0.0


@attrs.frozen(kw_only=True)
class Settings:
    """How bodies are simulated.

    Attributes:
        voxel_size: Edge of the lattice, m.
        duration: Simulated time, s; at most 1e9, as all times.
        temperature_amplitude: Degrees, the base temperature already subtracted. A voxel's linear strain is
            ``expansion * temperature_amplitude * sin(2 pi (t / period + phase))``.
        period: Of the actuation, s.
        start_time: When the actuation begins, s; its clock runs from time 0 all the same, so that a voxel may
            change its size with a jump.
        ramp: Seconds from then until the actuation has its full amplitude, in proportion to time.
        gravity: Acceleration along z, m/s2; negative pulls down.
        floor: Whether there is one: the plane z = 0, or z = x tan(floor_slope). Its push is vertical all the
            same.
        floor_slope: Degrees, from -89 to 89.
        fluid_drag: Half the density of the surrounding fluid times its drag coefficient, kg/m3. A facet of
            the outer surface is pushed back with this times its area and the square of its normal speed.
        time_step_fraction: Of the largest stable time step; above 0, at most 1.
        substeps: How many steps each such time step is made in; the number of steps is a multiple of it.
        bond_damping: Damping of bonds, as a fraction of critical.
        slow_damping: Damping of all motion against the ground, as a fraction of critical.
        floor_damping: Damping of the floor's push, as a fraction of critical.
        contact_damping: Damping of the push between voxels that touch, as a fraction of critical; none in the
            original engine. It never does more than end the approach within one step.
        self_collision: Whether the voxels of a body repel each other.
        contact_friction: Whether they brake each other too, with the mean of their dynamic frictions; the
            original engine does not.
        complete_contacts: Whether the list of possible contacts misses nothing. The original engine's may
            come late: it goes by the size of one voxel of the two, and by what touching voxels would need.
        collision_envelope: Voxels repel each other closer than this many of their mean sizes: 1.5 in the
            original engine, 1 where they really touch; 1 to 2.
        collision_horizon: Reach of the list of possible contacts, in voxel sizes; 1 to 4. The list is made
            anew when the fastest voxel may have moved by more than ``(horizon - 1) / 2`` lattice edges.
        collision_list_factor: The list leaves out voxels within ``floor(factor * horizon)`` bonds of each
            other, and the original engine's what is beyond ``factor * horizon`` lattice edges; 1 to 2.
        step_limit: A body that needs more steps is refused.
        largest_strain: A body with a bond stretched or compressed by more than this many lattice edges has
            diverged.
        largest_distance: A body with a voxel further from its start than this many times the longest edge of
            the canvas has diverged.
    """

    voxel_size: float
    duration: float
    temperature_amplitude: float
    period: float
    start_time: float = 0.0
    ramp: float = 0.0
    gravity: float = 0.0
    floor: bool = False
    floor_slope: float = 0.0
    fluid_drag: float = 0.0
    time_step_fraction: float = 0.9
    substeps: int = 1
    bond_damping: float = 1.0
    slow_damping: float = 0.01
    floor_damping: float = 0.8
    contact_damping: float = 0.0
    self_collision: bool = True
    contact_friction: bool = False
    complete_contacts: bool = False
    collision_envelope: float = 1.5
    collision_horizon: float = 2.0
    collision_list_factor: float = 1.5
    step_limit: int = 10_000_000
    largest_strain: float = 100.0
    largest_distance: float = 100.0


@attrs.frozen(eq=False)
class Result:
    """What became of a batch of bodies.

    Attributes:
        tracks: What was asked for, NaN from the step at which a body diverged. Positions in m: ``tip`` (the
            last occupied voxel in the order x fastest, then y, then z), ``face`` (the mass-weighted mean of
            the voxels with the largest initial x) and ``body`` (that of all voxels) are ``float64[N, S, 3]``;
            ``voxels`` is ``float64[N, S, X, Y, Z, 3]``, NaN in empty cells. ``energy`` is
            ``float64[N, S, 2]``, strain energy of the bonds and kinetic energy, J; ``strain`` is
            ``float64[N, S, 2]``, the least and the greatest strain of the bonds; ``momentum`` is
            ``float64[N, S, 6]``, linear in kg m/s and angular about the origin in kg m2/s.
        diverged_step: ``int64[N]``; 0, or the step (from 1) at which the body diverged.
    """

    tracks: dict[Track, NDArray[np.float64]]
    diverged_step: NDArray[np.int64]


class Model:
    """A canvas with its materials, settings and fixed cells; read-only once made.

    Args:
        canvas: Cells along x, y and z.
        palette: The material of each code that a cell may have, from 1 to 255. Code 0 is an empty cell.
        settings: How bodies are simulated.
        fixed: ``uint8[X, Y, Z]``, the degrees of freedom that a voxel has not, as bits (see ``FIX_ALL``).
        kernel: Which of ``KERNELS`` computes. By default what the environment variable ``EVOFRAME_KERNEL``
            names, or else the fastest.
        whole_body: Whether all of a body is computed to the very end, even where no sample can tell. That
            changes no bit of the results.

    Attributes:
        kernel: The name of the kernel that computes, to be recorded with its results.

    Raises:
        ValueError: A setting or a material is out of its range, or an array has the wrong shape.
        MemoryError: There is not enough memory.
    """

    def __init__(  # noqa: PLR0913 - what a model is made of, and how it computes
        self,
        canvas: tuple[int, int, int],
        palette: Mapping[int, Material],
        settings: Settings,
        fixed: ArrayLike,
        *,
        kernel: str | None = None,
        whole_body: bool = False,
    ) -> None:
        self.canvas: Final = canvas
        self.palette: Final = dict(palette)
        self.settings: Final = settings
        self.kernel: Final = _kernel(kernel)
        computing = {"kernel": _NUMBERS[self.kernel], "whole_body": whole_body}
        held = _cells("fixed", fixed, np.uint8, canvas)
        pointer = ffi.new("vox_model **")
        culprit = ffi.new("int64_t *")
        status = lib.vox_model_create(
            ffi.new("struct vox_settings *", _settings_fields(canvas, settings) | computing),
            _palette_entries(self.palette),
            lib.VOX_MAX_CODES,
            ffi.from_buffer("uint8_t[]", held),
            pointer,
            culprit,
        )
        if status != lib.VOX_OK:
            raise self._model_error(status, culprit[0])
        self._handle = ffi.gc(pointer[0], lib.vox_model_destroy)

    def time_steps(self, material: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
        """Return the time step and the number of steps of each body of a batch.

        Args:
            material: ``uint8[N, X, Y, Z]``, material codes.

        Returns:
            ``float64[N]`` in s, and ``int64[N]``.

        Raises:
            ValueError: A body is empty, has an unknown material or no usable time step, or needs too many
                steps; or the array has the wrong shape or type.
        """
        cells = _cells("material", material, np.uint8, (-1, *self.canvas))
        n = len(cells)
        dt, steps = np.empty(n), np.empty(n, np.int64)
        culprit = ffi.new("int64_t *")
        status = lib.vox_time_steps(
            self._handle,
            n,
            ffi.from_buffer("uint8_t[]", cells),
            ffi.from_buffer("double[]", dt),
            ffi.from_buffer("int64_t[]", steps),
            culprit,
        )
        _check_batch(status, culprit[0])
        return dt, steps

    def steps_at(
        self, material: ArrayLike, times: Sequence[float] | NDArray[np.float64]
    ) -> NDArray[np.int64]:
        """Return the steps after which each body of a batch is first at or past given times.

        Args:
            material: ``uint8[N, X, Y, Z]``, material codes.
            times: ``float64[S]``, s, not negative and within the duration.

        Returns:
            ``int64[N, S]``, to be given to :meth:`simulate`; two times may fall in one step.

        Raises:
            ValueError: A time is beyond the simulation, or a body cannot be simulated.
        """
        wanted = _array("times", times, np.float64, (-1,))
        outside = wanted[~((wanted >= 0.0) & (wanted <= self.settings.duration))]
        if outside.size:
            raise ValueError(
                f"times must be from 0 to the duration {self.settings.duration} s, got {outside[0]}"
            )
        dt, _ = self.time_steps(material)
        return np.ceil(wanted / dt[:, None] * (1.0 - _ROUNDING)).astype(np.int64)

    def simulate(
        self,
        material: ArrayLike,
        phase_cycles: ArrayLike,
        sample_steps: Sequence[int] | NDArray[np.int64],
        tracks: Iterable[Track] = get_args(Track),
    ) -> Result:
        """Simulate a batch of bodies, each on its own and to the end of the duration.

        Args:
            material: ``uint8[N, X, Y, Z]``, material codes.
            phase_cycles: ``float64[N, X, Y, Z]``, phase lead of each voxel in cycles, at most 1e6 either way;
                what stands at empty and passive cells does not matter.
            sample_steps: ``int64[S]``, or ``int64[N, S]`` for each body its own; strictly ascending, the
                steps after which samples are wanted (see :meth:`steps_at` for times). 0 is the initial state,
                and no body may have fewer steps than its last.
            tracks: What is wanted.

        Returns:
            The tracks that were asked for, and which bodies diverged.

        Raises:
            ValueError: An argument is out of its range or has the wrong shape or type; nothing was simulated.
            MemoryError: There is not enough memory.
        """
        cells = _cells("material", material, np.uint8, (-1, *self.canvas))
        n = len(cells)
        phases = _cells("phase_cycles", phase_cycles, np.float64, (n, *self.canvas))
        samples = _samples(sample_steps, n)
        shapes = self._track_shapes(n, samples.shape[1])
        unknown = sorted(set(tracks := tuple(tracks)) - set(shapes))
        if unknown:
            raise ValueError(f"unknown tracks {', '.join(unknown)}; there are {', '.join(shapes)}")
        out: dict[Track, NDArray[np.float64]] = {name: np.empty(shapes[name]) for name in tracks}
        diverged_step = np.empty(n, np.int64)
        culprit = ffi.new("int64_t *")
        pointers = {name: ffi.from_buffer("double[]", track) for name, track in out.items()}
        status = lib.vox_simulate(
            self._handle,
            n,
            ffi.from_buffer("uint8_t[]", cells),
            ffi.from_buffer("double[]", phases),
            samples.shape[1],
            ffi.from_buffer("int64_t[]", samples),
            ffi.new("struct vox_tracks *", pointers),
            ffi.from_buffer("int64_t[]", diverged_step),
            culprit,
        )
        _check_batch(status, culprit[0])
        if "voxels" in out:
            out["voxels"] = np.ascontiguousarray(out["voxels"].transpose(0, 1, 4, 3, 2, 5))
        return Result(out, diverged_step)

    def _track_shapes(self, n: int, samples: int) -> dict[Track, tuple[int, ...]]:
        """Return the shapes in which the solver writes."""
        point, two = (n, samples, 3), (n, samples, 2)
        voxels = (n, samples, *self.canvas[::-1], 3)
        points: dict[Track, tuple[int, ...]] = {"tip": point, "face": point, "body": point, "voxels": voxels}
        return points | {"energy": two, "strain": two, "momentum": (n, samples, 6)}

    def _model_error(self, status: int, culprit: int) -> Exception:
        """Return the error for a model that could not be made, with the value that was given."""
        field = ffi.typeof("enum vox_status").elements[status].removeprefix("VOX_BAD_").lower()
        if field == "canvas":
            return _error(status, f", got {self.canvas}")
        if field == "fixed":
            return _error(status, f" (cell {culprit} in the order x fastest, then y, then z)")
        if culprit >= 0:
            return _error(status, f", got {getattr(self.palette[culprit], field)} for material {culprit}")
        if hasattr(self.settings, field):
            return _error(status, f", got {getattr(self.settings, field)}")
        return _error(status, "")


def _kernel(name: str | None) -> str:
    """Return the name of the kernel to use."""
    asked, where = (name, "kernel") if name else (os.environ.get("EVOFRAME_KERNEL"), "EVOFRAME_KERNEL")
    if asked and asked not in KERNELS:
        raise ValueError(f"{where} must be one of {', '.join(KERNELS)} on this processor, got {asked}")
    return asked or KERNELS[-1]


def _samples(sample_steps: ArrayLike, n_bodies: int) -> NDArray[np.int64]:
    """Return the sampled steps of each body, ``int64[N, S]``."""
    given = np.asarray(sample_steps)
    own = _array("sample_steps", given, np.int64, (n_bodies, -1) if given.ndim == 2 else (-1,))
    return np.ascontiguousarray(np.broadcast_to(own, (n_bodies, own.shape[-1])))


def _settings_fields(canvas: tuple[int, int, int], settings: Settings) -> dict[str, int | float]:
    nx, ny, nz = canvas
    return {"nx": nx, "ny": ny, "nz": nz, **attrs.asdict(settings)}


def _palette_entries(palette: Mapping[int, Material]) -> Any:
    """Return the palette as the solver wants it: indexed by code."""
    entries = ffi.new("struct vox_material[]", lib.VOX_MAX_CODES)
    for code, material in palette.items():
        if not 0 < code < lib.VOX_MAX_CODES:
            raise _error(lib.VOX_BAD_PALETTE, f", got {code}")
        entries[code] = {"used": 1, **attrs.asdict(material)}
    return entries


def _array(name: str, values: ArrayLike, dtype: type[np.generic], shape: tuple[int, ...]) -> NDArray[Any]:
    """Return an array of a type, if that holds all its values exactly, and of a shape (-1: any length)."""
    array = np.asarray(values)
    wanted = np.dtype(dtype)
    if array.size and (array.dtype == np.bool_ or not np.can_cast(array.dtype, wanted)):
        raise ValueError(f"{name} must be {wanted}, got {array.dtype}")
    fits = len(shape) == array.ndim and all(w in (-1, n) for w, n in zip(shape, array.shape, strict=True))
    if not fits:
        expected = ", ".join("N" if n == -1 else str(n) for n in shape)
        raise ValueError(f"{name} must have the shape [{expected}], got {list(array.shape)}")
    return np.ascontiguousarray(array, dtype=wanted)


def _cells(name: str, values: ArrayLike, dtype: type[np.generic], shape: tuple[int, ...]) -> NDArray[Any]:
    """Return an array over cells in the solver's order: x fastest, then y, then z."""
    array = _array(name, values, dtype, shape)
    return np.array(array.swapaxes(-1, -3), order="C")  # a copy, which nobody changes after it was checked


def _error(status: int, detail: str) -> Exception:
    """Return the error that a status stands for."""
    message = ffi.string(lib.vox_status_message(status)).decode() + detail
    return MemoryError(message) if status == lib.VOX_NO_MEMORY else ValueError(message)


def _check_batch(status: int, culprit: int) -> None:
    """Raise what is wrong with a batch, if anything, naming the body."""
    if status != lib.VOX_OK:
        raise _error(status, f" (body {culprit})" if culprit >= 0 else "")
