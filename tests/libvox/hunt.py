"""Hunt for bodies whose recorded points depend on what the solver leaves out.

``python tests/libvox/hunt.py 600`` (``make hunt``) draws bodies and settings for ten minutes: blobs of
low-frequency patterns like those of evolution, noise, parallel prongs, and loose parts; stiff next to soft
materials, small to absurd strains, few to many steps. Each batch is simulated twice, as usual and with
``whole_body=True``, and compared bit for bit. Only samples after the whole body has diverged may differ: what
diverges out of reach of every sample is not computed.

The program prints its first seed, the number of simulations, the share that fell back to the whole body, and
the differences. It exits with 1 after the first difference, whose seed it prints.
"""

from __future__ import annotations

import argparse
import secrets
import sys
import time
from collections import Counter

import attrs
import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from evoframe_libvox import FIX_ALL, KERNELS, Material, Model, Result, Settings, Track

Bytes = NDArray[np.uint8]
Floats = NDArray[np.float64]

WHAT = ("bodies", "simulations", "repeated", "diverged")  # is counted
EDGE = 0.05  # m
MOST_WORK = 40_000  # voxels times steps of a simulation
SHORTEST = Settings(voxel_size=EDGE, duration=1e-9, temperature_amplitude=0.0, period=1.0)


@attrs.frozen
class Case:
    """A batch of controllers of one body, and its kind."""

    kind: str
    palette: dict[int, Material]
    settings: Settings
    fixed: Bytes
    bodies: Bytes
    phases: Floats
    samples: NDArray[np.int64]
    tracks: tuple[Track, ...]
    kernel: str

    def simulate(self, *, whole_body: bool) -> Result:
        x, y, z = self.fixed.shape
        model = Model(
            (x, y, z), self.palette, self.settings, self.fixed, kernel=self.kernel, whole_body=whole_body
        )
        return model.simulate(self.bodies, self.phases, self.samples, self.tracks)


# ---- bodies


def wave(rng: Generator, canvas: tuple[int, ...], cells: float) -> Floats:
    """Return a sum of plane waves whose lengths are around *cells*."""
    places = np.indices(canvas).astype(float)
    waves = rng.normal(size=(4, 3)) * 2.0 * np.pi / cells
    turns = rng.uniform(0.0, 2.0 * np.pi, 4)
    field: Floats = np.sin(np.tensordot(waves, places, 1) + turns.reshape(4, 1, 1, 1)).sum(axis=0)
    return field


def blob(rng: Generator, canvas: tuple[int, ...]) -> Bytes:
    field = wave(rng, canvas, rng.uniform(5.0, 25.0))
    return (field > np.quantile(field, rng.uniform(0.05, 0.75))).astype(np.uint8)


def noise(rng: Generator, canvas: tuple[int, ...]) -> Bytes:
    return (rng.random(canvas) < rng.uniform(0.25, 1.0)).astype(np.uint8)


def prongs(rng: Generator, canvas: tuple[int, ...]) -> Bytes:
    """Return bars along x that are connected at the first or the last slab, or only because it is clamped."""
    body = np.zeros(canvas, np.uint8)
    gap, width = rng.integers(1, 6), rng.integers(1, 4)
    y, z = np.indices(canvas)[1:]
    across = z if rng.random() < 0.3 else y
    body[across % (gap + width) < width] = 1
    if rng.random() < 0.5:
        body[:, :, rng.integers(1, canvas[2] + 1) :] = 0
    if rng.random() < 0.7:
        body[0 if rng.random() < 0.7 else -1] = 1
    return body


def parts(rng: Generator, canvas: tuple[int, ...]) -> Bytes:
    """Return boxes, which may overlap."""
    body = np.zeros(canvas, np.uint8)
    for _ in range(rng.integers(2, 6)):
        lower = [rng.integers(0, n) for n in canvas]
        body[
            tuple(
                slice(at, at + rng.integers(1, max(2, n // 2))) for at, n in zip(lower, canvas, strict=True)
            )
        ] = 1
    return body


KINDS = {"blob": blob, "noise": noise, "prongs": prongs, "parts": parts}


def draw_canvas(rng: Generator) -> tuple[int, int, int]:
    if rng.random() < 0.3:
        return (20, 8, 8)
    x, y, z = rng.permutation([rng.integers(4, 25), rng.integers(1, 9), rng.integers(1, 7)])
    return (int(x), int(y), int(z))


def draw_fixed(rng: Generator, canvas: tuple[int, ...]) -> Bytes:
    fixed = np.zeros(canvas, np.uint8)
    match rng.integers(5):
        case 0 | 1:
            fixed[0] = FIX_ALL
        case 2:
            fixed[:, :, 0] = FIX_ALL
        case 3:
            fixed[:] = rng.choice(np.array([0, 0, 0, 0, 0, 4, 7, 56, 63], np.uint8), canvas)
    return fixed


# ---- materials and settings


def draw_palette(rng: Generator) -> dict[int, Material]:
    """Draw one to three materials; strains are the expansions times 10 degrees."""
    strain = float(rng.choice([0.05, 0.145, 0.145, 0.3, 0.6, 1.5, 3.0])) * rng.uniform(0.5, 1.0)
    contrast = float(rng.choice([1.0, 1.0, 3.0, 100.0]))
    alike = rng.random() < 0.5
    palette = {}
    for code in range(1, int(rng.integers(2, 5))):
        palette[code] = Material(
            youngs_modulus=5e6 if alike else 5e6 * contrast ** rng.uniform(-1.0, 0.0),
            poisson_ratio=0.35,
            density=1e6 if alike else 1e6 * 2.0 ** rng.uniform(-1.0, 1.0),
            expansion=0.0
            if code == 1 and rng.random() < 0.5
            else float(rng.choice([-1.0, 1.0])) * strain / 10.0,
            static_friction=1.0,
            dynamic_friction=0.5,
        )
    return palette


def draw_settings(rng: Generator, dt: float, steps: int) -> Settings:
    """Draw settings; times are multiples of the time step."""

    def seldom(value: float, other: float) -> float:
        return value if rng.random() < 0.75 else other

    floor = rng.random() < 0.15
    start = seldom(0.0, float(rng.integers(0, steps + 1))) * dt
    return attrs.evolve(
        SHORTEST,
        duration=(steps - 0.5) * dt,
        temperature_amplitude=10.0,
        period=float(rng.choice([4.0, 12.0, 80.0, 80.0, 300.0])) * rng.uniform(0.5, 1.5) * dt,
        start_time=start,
        ramp=seldom(0.0, float(rng.integers(0, steps + 1))) * dt,
        smallest_size=seldom(0.1, 0.5),
        largest_size=seldom(3.0, 10.0),
        size_clamp=bool(rng.random() < 0.3),
        gravity=seldom(0.0, float(rng.choice([-9.81, -300.0, 100.0, -3000.0]))),
        floor=bool(floor),
        falling_code=int(seldom(0, 1)) if floor else 0,
        bond_damping=seldom(1.0, float(rng.choice([0.0, 0.2, 3.0]))),
        slow_damping=seldom(0.01, float(rng.choice([0.0, 0.1]))),
        self_collision=bool(rng.random() < 0.9),
        complete_contacts=bool(rng.random() < 0.25),
        collision_envelope=seldom(1.5, float(rng.choice([1.0, 1.2, 2.0]))),
        collision_horizon=seldom(2.0, float(rng.choice([1.2, 1.6, 3.0, 4.0]))),
        collision_list_factor=seldom(1.5, float(rng.choice([1.0, 2.0]))),
    )


def draw_phases(rng: Generator, canvas: tuple[int, ...]) -> Floats:
    match rng.integers(4):
        case 0:
            return np.full(canvas, rng.uniform(-1.0, 1.0))
        case 1:
            return rng.uniform(-1.0, 1.0, canvas)
        case 2:
            return np.where(wave(rng, canvas, 16.0) > 0.0, 0.5, 0.0) + rng.uniform(-1.0, 1.0)
        case _:
            return wave(rng, canvas, rng.uniform(5.0, 40.0)) / 4.0


def draw_samples(rng: Generator, n: int, steps: int) -> NDArray[np.int64]:
    count = int(rng.integers(1, min(steps, 3) + 1))
    rows = [np.sort(rng.choice(steps + 1, count, replace=False)) for _ in range(n)]
    return np.array(rows if rng.random() < 0.3 else rows[:1] * n)


def draw(seed: int) -> Case:
    """Draw a case; the same for the same seed."""
    rng = np.random.default_rng(seed)
    kind = str(rng.choice(list(KINDS), p=[0.5, 0.15, 0.2, 0.15]))
    canvas = draw_canvas(rng)
    shape = KINDS[kind](rng, canvas)
    shape[tuple(rng.integers(0, n) for n in canvas)] = 1
    palette = draw_palette(rng)
    codes = np.array(list(palette), np.uint8)
    pick = rng.random(canvas) if rng.random() < 0.5 else wave(rng, canvas, rng.uniform(5.0, 25.0)) % 1.0
    body = shape * codes[(pick * len(codes)).astype(int)]
    fixed = draw_fixed(rng, canvas)
    dt = float(Model(canvas, palette, SHORTEST, fixed).time_steps(body[None])[0][0])
    most = max(3, min(150, MOST_WORK // int(np.count_nonzero(body))))
    steps = int(rng.integers(2, most + 1)) if rng.random() < 0.5 else min(22, most)
    settings = draw_settings(rng, dt, steps)
    n = int(rng.integers(1, 5))
    phases = np.array([draw_phases(rng, canvas) for _ in range(n)])
    bodies = np.repeat(body[None], n, axis=0)
    steps = int(Model(canvas, palette, settings, fixed).time_steps(body[None])[1][0])
    samples = draw_samples(rng, n, steps)
    tracks: tuple[Track, ...] = ("tip", "face") if rng.random() < 0.3 else ("tip",)
    kernel = str(rng.choice(KERNELS)) if rng.random() < 0.2 else KERNELS[-1]
    return Case(kind, palette, settings, fixed, bodies, phases, samples, tracks, kernel)


# ---- the hunt


def differences(case: Case, cone: Result, whole: Result) -> list[int]:
    """Return the controllers with different results."""
    wrong = []
    for i in range(len(case.bodies)):
        at, end = int(cone.diverged_step[i]), int(whole.diverged_step[i])
        before = len(case.samples[i]) if end == 0 else int(np.searchsorted(case.samples[i], end))
        same = all(
            np.array_equal(cone.tracks[t][i][:before], whole.tracks[t][i][:before]) for t in case.tracks
        )
        if not same or (at > 0 and not 0 < end <= at):
            wrong.append(i)
    return wrong


def describe(case: Case, cone: Result, whole: Result, wrong: list[int]) -> str:
    lines = [
        f"{case.kind} on {case.fixed.shape}, kernel {case.kernel}, controllers {wrong} of {len(case.bodies)}"
    ]
    lines += [str(case.settings), *map(str, case.palette.items())]
    for i in wrong[:2]:
        lines.append(
            f"samples {case.samples[i]}, diverged {cone.diverged_step[i]} and {whole.diverged_step[i]}"
        )
        lines += [
            f"{t}: {np.nanmax(np.abs(cone.tracks[t][i] - whole.tracks[t][i])) / EDGE:g} edges"
            for t in case.tracks
        ]
    return "\n".join(lines)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("seconds", type=float)
    parser.add_argument("--seed", type=int, default=secrets.randbelow(10**9))
    parser.add_argument("--cases", type=int, default=10**9)
    parser.add_argument("--go-on", action="store_true")
    options = parser.parse_args()
    counts: Counter[str] = Counter()
    kinds: Counter[str] = Counter()
    end = time.monotonic() + options.seconds
    sys.stdout.write(f"from seed {options.seed}\n")
    for seed in range(options.seed, options.seed + options.cases):
        if time.monotonic() > end:
            break
        case = draw(seed)
        cone, whole = case.simulate(whole_body=False), case.simulate(whole_body=True)
        counts["bodies"] += 1
        counts["simulations"] += len(case.bodies)
        counts["repeated"] += int(cone.repeated.sum())
        counts["diverged"] += int((whole.diverged_step > 0).sum())
        wrong = differences(case, cone, whole)
        if wrong:
            kinds[case.kind] += 1
            sys.stdout.write(f"seed {seed}: {describe(case, cone, whole, wrong)}\n")
            if not options.go_on:
                raise SystemExit(1)
    found = ", ".join(f"{counts[what]} {what}" for what in WHAT)
    sys.stdout.write(f"{found}; differences: {dict(kinds) or 'none'}\n")
    if kinds:
        raise SystemExit(1)


if __name__ == "__main__":
    main()
