"""Python binding of the voxel solver for NumPy arrays.

Arrays over a canvas are indexed ``[x, y, z]``. Units are meter, second, kilogram, pascal and degree; phases
are in cycles. The solver is the C library in ``libvox/``. It checks the values of all arguments, releases the
GIL during computation, and keeps no state except reusable memory, so that threads can share a model.
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
"""Names of the kernels that this processor supports, the fastest last. ``scalar`` is the reference, which
processes one bond after another. The others are compiled from one source and return the same bits."""

VERSION: Final[str] = ffi.string(lib.vox_version()).decode()
"""Version of the library; the second number increases with every change of the interface or of a bit of the
results."""

COMPILER: Final[str] = ffi.string(lib.vox_compiler()).decode()
"""Name and version of the compiler that built the library."""

FIX_ALL: Final = 63
"""All six degrees of freedom of a voxel: bits 1, 2, 4 for translation along x, y, z, and 8, 16, 32 for
rotation about these axes."""


@attrs.frozen
class Range:
    """Range of a setting or of a property of a material; ``x in range`` checks a number.

    Attributes:
        lower: Lower bound, in the unit of the setting; ``-inf`` without a bound.
        upper: Upper bound; ``inf`` without a bound.
        lower_included: Whether the range includes the lower bound; never if it is infinite.
        upper_included: Whether the range includes the upper bound.
        whole: Whether numbers must be integers.
        words: Description of the range, such as ``above 0 and at most 1e9 s``.
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
    """Return the ranges listed by the library: name of the field -> range."""
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
"""Range of each number in :class:`Settings`; :class:`Model` rejects numbers outside."""

PROPERTY_RANGES: Final = _ranges(lib.vox_property_range)
"""Range of each number in :class:`Material`. An expansion must also be finite when multiplied by the
temperature amplitude."""

Track = Literal["tip", "face", "body", "voxels", "energy", "strain", "momentum"]


_ROUNDING: Final = 1e-12  # relative; tolerance for times that are multiples of the time step


@attrs.frozen
class Material:
    """Material of a voxel.

    Attributes:
        youngs_modulus: Young's modulus, Pa; 1e-6 to 1e18.
        poisson_ratio: Poisson's ratio, 0 to 0.5; it affects only the twist of bonds.
        density: Density, kg/m3; 1e-6 to 1e18.
        expansion: Linear thermal expansion per degree; 0 for passive materials, negative for materials that
            contract when others expand.
        static_friction: Coefficient of static friction on the floor.
        dynamic_friction: Coefficient of dynamic friction on the floor and between voxels.
    """

    youngs_modulus: float
    poisson_ratio: float
    density: float
    expansion: float
    static_friction: float = 0.0
    dynamic_friction: float = 0.0


@attrs.frozen(kw_only=True)
class Settings:
    """Settings of a simulation.

    Attributes:
        voxel_size: Edge of the lattice, m.
        duration: Simulated time, s; at most 1e9, like all times.
        temperature_amplitude: Amplitude above the base temperature, degrees. The linear strain of a voxel is
            ``expansion * temperature_amplitude * sin(2 pi (t / period + phase))``.
        period: Period of the actuation, s.
        start_time: Start of the actuation, s; its phase still runs from time 0, so that sizes may jump.
        ramp: Time over which the actuation grows linearly to its full amplitude, s.
        smallest_size: Smallest size of a voxel, in lattice edges; 1e-3 to 1.
        largest_size: Largest size of a voxel, in lattice edges; 1 to 10.
        size_clamp: Whether a size beyond a limit becomes the limit; in the original engine it keeps its last
            value.
        gravity: Acceleration along z, m/s2; negative is down.
        floor: Whether to add a floor: the plane z = x tan(floor_slope). Its normal force is always vertical.
        floor_slope: Slope of the floor, degrees; -89 to 89.
        falling_code: The motion of a body ends when a voxel of this material code is below the plane of the
            floor, even if there is no floor; further samples repeat its state. 0: none.
        fluid_drag: Half the density of the surrounding fluid times the drag coefficient, kg/m3. The drag on a
            facet of the surface is this times its area and the square of its normal speed.
        fluid_by_size: Whether a voxel reaches half its size, and the fluid acts only on faces that are
            connected to the outside. In the original engine, a voxel reaches half an edge plus the strain of
            the bond on that side in the previous step, and the fluid acts on every face without a neighbor.
        time_step_fraction: Time step as a fraction of the largest stable one; above 0, at most 1.
        substeps: Number of steps in each such time step; the number of steps is a multiple of it.
        bond_damping: Damping of bonds, as a fraction of critical.
        slow_damping: Damping of all motion relative to the ground, as a fraction of critical.
        floor_damping: Damping of the floor contact, as a fraction of critical.
        contact_damping: Damping of contacts between voxels, as a fraction of critical; 0 in the original
            engine. It is limited to the damping that stops the approach within one step.
        self_collision: Whether the voxels of a body repel each other.
        contact_friction: Whether contacts have friction, with the mean dynamic friction of both voxels; not
            in the original engine.
        complete_contacts: Whether the list of contact candidates is complete. In the original engine it may
            be late, because its reach depends on the size of one of the two voxels and assumes that contacts
            start when voxels touch.
        collision_envelope: Distance at which repulsion starts, in mean voxel sizes: 1.5 in the original
            engine, 1 for touching voxels; 1 to 2.
        collision_horizon: Reach of the list of contact candidates, in voxel sizes; 1 to 10. The list is
            rebuilt when the fastest voxel may have moved by more than ``(horizon - 1) / 2`` lattice edges.
        collision_list_factor: The list excludes voxels within ``floor(factor * horizon)`` bonds of each
            other, and the original engine's list those beyond ``factor * horizon`` lattice edges; 1 to 2.
        step_limit: Maximum number of steps of a body.
        largest_strain: Absolute strain of a bond beyond which a body has diverged.
        largest_distance: Distance of a voxel from its start, in longest edges of the canvas, beyond which a
            body has diverged.
    """

    voxel_size: float
    duration: float
    temperature_amplitude: float
    period: float
    start_time: float = 0.0
    ramp: float = 0.0
    smallest_size: float = 0.1
    largest_size: float = 3.0
    size_clamp: bool = False
    gravity: float = 0.0
    floor: bool = False
    floor_slope: float = 0.0
    falling_code: int = 0
    fluid_drag: float = 0.0
    fluid_by_size: bool = False
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
    """Result of the simulation of a batch of bodies.

    Attributes:
        tracks: The requested tracks, NaN from the step at which a body diverged. Positions in m: ``tip`` (the
            last voxel in the order x fastest, then y, then z), ``face`` (the mass-weighted mean of the voxels
            with the largest initial x) and ``body`` (the mean of all voxels) are ``float64[N, S, 3]``;
            ``voxels`` is ``float64[N, S, X, Y, Z, 3]``, NaN in empty cells. ``energy`` is
            ``float64[N, S, 2]``, strain energy of the bonds and kinetic energy, J; ``strain`` is
            ``float64[N, S, 2]``, smallest and largest strain of a bond; ``momentum`` is
            ``float64[N, S, 6]``, linear in kg m/s and angular about the origin in kg m2/s.
        diverged_step: ``int64[N]``; 0, or the step (from 1) at which the body diverged.
        repeated: ``bool[N]``; whether the body was simulated a second time, as a whole, because voxels that
            were left out might have affected a sample.
    """

    tracks: dict[Track, NDArray[np.float64]]
    diverged_step: NDArray[np.int64]
    repeated: NDArray[np.bool_]


class Model:
    """A canvas with materials, settings and fixed cells; read-only after its creation.

    Args:
        canvas: Number of cells along x, y and z.
        palette: Code (1 to 255) -> material. Code 0 is an empty cell.
        settings: Settings of the simulation.
        fixed: Clamped degrees of freedom of each cell as bits, ``uint8[X, Y, Z]`` (see ``FIX_ALL``).
        kernel: One of ``KERNELS``; by default that of the environment variable ``EVOFRAME_KERNEL``, or the
            fastest.
        whole_body: Whether to simulate the whole body to the end of the duration, so that a divergence
            anywhere counts. Otherwise only what can affect the samples is simulated, where this can be
            decided, and a body that diverges out of their reach has not diverged. Samples before a divergence
            are the same, bit for bit.

    Attributes:
        kernel: Name of the kernel, for the provenance of results.

    Raises:
        ValueError: A setting or a material is out of range, or an array has the wrong shape.
        MemoryError: Memory is insufficient.
    """

    def __init__(  # noqa: PLR0913 - parts of a model, and computation
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
            ValueError: A body is empty, has an unknown material, has no usable time step or requires too many
                steps, or the array has the wrong shape or type.
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
        """Return the first steps of each body of a batch that reach given times.

        Args:
            material: ``uint8[N, X, Y, Z]``, material codes.
            times: ``float64[S]``, s, from 0 to the duration.

        Returns:
            ``int64[N, S]``, for :meth:`simulate`; two times may result in the same step.

        Raises:
            ValueError: A time is beyond the simulation, or a body cannot be simulated.
        """
        wanted = _array("times", times, np.float64, (-1,))
        outside = wanted[~((wanted >= 0.0) & (wanted <= self.settings.duration))]
        if outside.size:
            raise ValueError(
                f"times must be between 0 and the duration {self.settings.duration} s, got {outside[0]}"
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
        """Simulate a batch of independent bodies.

        Args:
            material: ``uint8[N, X, Y, Z]``, material codes.
            phase_cycles: ``float64[N, X, Y, Z]``, phase lead of each voxel in cycles, -1e6 to 1e6; ignored in
                empty and passive cells.
            sample_steps: ``int64[S]`` for all bodies or ``int64[N, S]`` for each body, strictly ascending:
                steps after which to sample (see :meth:`steps_at` for times). 0 is the initial state; the last
                value is at most the number of steps.
            tracks: Names of the requested tracks.

        Returns:
            The requested tracks, and the divergence of each body.

        Raises:
            ValueError: An argument is out of range or has the wrong shape or type; nothing was simulated.
            MemoryError: Memory is insufficient.
        """
        cells = _cells("material", material, np.uint8, (-1, *self.canvas))
        n = len(cells)
        phases = _cells("phase_cycles", phase_cycles, np.float64, (n, *self.canvas))
        samples = _samples(sample_steps, n)
        shapes = self._track_shapes(n, samples.shape[1])
        unknown = sorted(set(tracks := tuple(tracks)) - set(shapes))
        if unknown:
            raise ValueError(f"unknown tracks {', '.join(unknown)}; tracks: {', '.join(shapes)}")
        out: dict[Track, NDArray[np.float64]] = {name: np.empty(shapes[name]) for name in tracks}
        diverged_step = np.empty(n, np.int64)
        repeated = np.zeros(n, np.uint8)
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
            ffi.from_buffer("uint8_t[]", repeated),
            culprit,
        )
        _check_batch(status, culprit[0])
        if "voxels" in out:
            out["voxels"] = np.ascontiguousarray(out["voxels"].transpose(0, 1, 4, 3, 2, 5))
        return Result(out, diverged_step, repeated != 0)

    def _track_shapes(self, n: int, samples: int) -> dict[Track, tuple[int, ...]]:
        """Return the shapes of the arrays that the solver writes."""
        point, two = (n, samples, 3), (n, samples, 2)
        voxels = (n, samples, *self.canvas[::-1], 3)
        points: dict[Track, tuple[int, ...]] = {"tip": point, "face": point, "body": point, "voxels": voxels}
        return points | {"energy": two, "strain": two, "momentum": (n, samples, 6)}

    def _model_error(self, status: int, culprit: int) -> Exception:
        """Return the error for a model that could not be created, with the invalid value."""
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
    """Return the palette for the solver, indexed by code."""
    entries = ffi.new("struct vox_material[]", lib.VOX_MAX_CODES)
    for code, material in palette.items():
        if not 0 < code < lib.VOX_MAX_CODES:
            raise _error(lib.VOX_BAD_PALETTE, f", got {code}")
        entries[code] = {"used": 1, **attrs.asdict(material)}
    return entries


def _array(name: str, values: ArrayLike, dtype: type[np.generic], shape: tuple[int, ...]) -> NDArray[Any]:
    """Convert values to a type that holds them exactly, and check the shape (-1: any length)."""
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
    """Convert an array over cells to the order of the solver: x fastest, then y, then z."""
    array = _array(name, values, dtype, shape)
    return np.array(array.swapaxes(-1, -3), order="C")  # a copy, so that checked values cannot change


def _error(status: int, detail: str) -> Exception:
    """Return the exception for a status."""
    message = ffi.string(lib.vox_status_message(status)).decode() + detail
    return MemoryError(message) if status == lib.VOX_NO_MEMORY else ValueError(message)


def _check_batch(status: int, culprit: int) -> None:
    """Raise the error for a batch, with the index of the body, unless the status is OK."""
    if status != lib.VOX_OK:
        raise _error(status, f" (body {culprit})" if culprit >= 0 else "")
