"""Bits of what the solver computes, compared with those of whole bodies, for every kernel.

Designs that evolve in runs of the preset ``paper``, the published bodies with random controllers, and bodies
of noise, of which half have softer or stiffer materials and larger strains, are simulated as usual and with
``whole_body=True``. The positions of the tip must be equal, bit for bit; only a body that diverges as a whole
may differ. Prints a table in Markdown, also with the share of bodies that were simulated a second time as a
whole (docs/solver.md, "What is not computed").

    python -m benchmarks.equality --evolved 20000 --published 3600 --noise 20000
"""

from __future__ import annotations

import argparse
import itertools
from collections import Counter
from collections.abc import Iterable, Iterator

import attrs
import numpy as np
from numpy.typing import NDArray

import evoframe
from benchmarks.recording import Batch, recording
from benchmarks.subjects import canvas, objective, published, solver, vox
from evoframe import CONTRACTILE, CONTROLLER, MORPHOLOGY, PASSIVE
from evoframe_libvox import KERNELS
from evoframe_simulators.vox import Vox, clocks_of

_CHUNK = 100  # bodies at a time


@attrs.frozen
class Bodies:
    """Bodies with controllers, and the settings with which they are simulated.

    Attributes:
        simulator: The settings.
        material: ``uint8[N, X, Y, Z]``, codes.
        phase: ``float64[N, X, Y, Z]``, cycles.
    """

    simulator: Vox
    material: NDArray[np.uint8]
    phase: NDArray[np.float64]


def evolved(count: int) -> Iterator[Bodies]:
    """Yield the designs that runs with the seeds 1, 2, ... simulate."""
    left = count
    for seed in itertools.count(1):
        config = evoframe.load_config("paper", overrides=[f"run.seed={seed}", "executor=serial"])
        batches: list[Batch] = []
        with recording(config, batches), evoframe.assemble(config) as coevolution:
            for _ in coevolution:
                pass
        designs = list(itertools.chain.from_iterable(batches))[:left]
        for first in range(0, len(designs), _CHUNK):
            chunk = designs[first : first + _CHUNK]
            material, phase = (np.stack([d.roles[role] for d in chunk]) for role in (MORPHOLOGY, CONTROLLER))
            yield Bodies(vox(), material, phase)
        left -= len(designs)
        if left == 0:
            return


def with_random_controllers(count: int, rng: np.random.Generator) -> Iterator[Bodies]:
    """Yield the published bodies in turns."""
    shapes = {design.roles[MORPHOLOGY].tobytes(): design.roles[MORPHOLOGY] for design in published().values()}
    for size, material in zip(_sizes(count), itertools.cycle(shapes.values()), strict=False):
        yield Bodies(vox(), np.repeat(material[None], size, axis=0), _phases(rng, size))


def noise(count: int, rng: np.random.Generator) -> Iterator[Bodies]:
    """Yield random voxels; every second chunk has other materials, and twice the duration."""
    for number, size in enumerate(_sizes(count)):
        shape = (size, *canvas())
        material = np.where(rng.random(shape) < 0.6, CONTRACTILE, PASSIVE)  # codes
        material = np.where(rng.random(shape) < rng.uniform(0.3, 1.0), material, 0).astype(np.uint8)
        material[:, -1, -1, -1] = CONTRACTILE
        simulator = vox() if number % 2 == 0 else _softer(rng)
        yield Bodies(simulator, material, _phases(rng, size))


def _softer(rng: np.random.Generator) -> Vox:
    return attrs.evolve(
        vox(),
        youngs_modulus=5e6 * float(rng.choice([0.2, 1.0, 4.0])),
        expansion_coefficient=float(rng.uniform(0.005, 0.03)),
        duration=2.0 * vox().duration,
    )


def _sizes(count: int) -> Iterable[int]:
    return (min(_CHUNK, count - first) for first in range(0, count, _CHUNK))


def _phases(rng: np.random.Generator, size: int) -> NDArray[np.float64]:
    return rng.uniform(-0.5, 0.5, (size, *canvas()))


def compared(bodies: Bodies, kernel: str) -> Counter[str]:
    """Return the numbers of bodies, of different ones, and of repeated and diverged ones."""
    usual, whole = (
        solver(bodies.simulator, kernel=kernel, whole_body=whole_body) for whole_body in (False, True)
    )
    record = objective().record
    steps = np.stack([clock.samples(record) for clock in clocks_of(bodies.simulator, usual, bodies.material)])
    one = usual.simulate(bodies.material, bodies.phase, steps, ["tip"])
    all_of_it = whole.simulate(bodies.material, bodies.phase, steps, ["tip"])
    diverged = all_of_it.diverged_step > 0
    same = (one.tracks["tip"] == all_of_it.tracks["tip"]).all(axis=(1, 2)) & (one.diverged_step == 0)
    return Counter(
        bodies=len(same),
        different=int((~same & ~diverged).sum()),
        repeated=int(one.repeated.sum()),
        diverged=int(diverged.sum()),
    )


def main() -> None:
    """Compare the bodies, and print the table; exit with 1 if any differ."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    for kind in ("evolved", "published", "noise"):
        parser.add_argument(f"--{kind}", type=int, default=600, metavar="N")
    options = parser.parse_args()
    rng = np.random.default_rng(1)
    kinds = {
        "evolved with `paper`": evolved(options.evolved),
        "published, random controllers": with_random_controllers(options.published, rng),
        "noise, soft and stiff": noise(options.noise, rng),
    }
    lines = ["| bodies | kernel | number | different | repeated | diverge as a whole |", "|---" * 6 + "|"]
    different = 0
    for kind, chunks in kinds.items():
        counts: dict[str, Counter[str]] = {kernel: Counter() for kernel in KERNELS}
        for bodies in chunks:
            for kernel in KERNELS:
                counts[kernel] += compared(bodies, kernel)
        lines += [_line(kind, kernel, found) for kernel, found in counts.items()]
        different += sum(found["different"] for found in counts.values())
    print("\n".join(lines))  # noqa: T201 - a command
    raise SystemExit(different > 0)


def _line(kind: str, kernel: str, found: Counter[str]) -> str:
    share = 100.0 * found["repeated"] / found["bodies"] if found["bodies"] else 0.0
    numbers = f"{found['bodies']:,} | {found['different']:,} | {share:.3g} % | {found['diverged']:,}"
    return f"| {kind} | {kernel} | {numbers} |"


if __name__ == "__main__":
    main()
