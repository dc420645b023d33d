"""Bending of the bar of the preset ``bending``, and the ratio of its drive frequency to its first mode.

Measures the first bending mode of the bar (solid, and enclosure only) from its oscillation under a small,
suddenly applied weight, and the displacement of a bimorph of the preset, whose upper half contracts while its
lower half expands. Then it measures the displacement for other drive frequencies and dampings; those of the
preset were chosen from these figures.

    python -m benchmarks.bending
"""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Sequence
from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

import evoframe
from evoframe import CONTRACTILE, CONTROLLER, MORPHOLOGY, PASSIVE, Design, Record
from evoframe.designs.verifying import verify_design

FREQUENCIES = (1.0, 2.0, 4.0, 6.0, 8.0, 9.0, 10.0, 12.0)  # Hz
DAMPINGS = (0.0, 0.001, 0.003, 0.01)


def bar(canvas: Sequence[int], inside: int) -> NDArray[np.uint8]:
    """Return a passive enclosure around an *inside* of one material."""
    body = np.full(canvas, PASSIVE, np.uint8)
    body[1:-1, 1:-1, 1:-1] = inside
    return body


def bimorph(canvas: Sequence[int]) -> Design:
    """Return a bar whose upper half contracts while its lower half expands."""
    offsets = np.zeros(canvas)
    offsets[:, :, : canvas[2] // 2] = math.pi
    return Design({MORPHOLOGY: bar(canvas, CONTRACTILE), CONTROLLER: offsets})


def first_mode(vox: Any, body: NDArray[np.uint8]) -> float:
    """Return the frequency, Hz, at which a bar oscillates around its equilibrium under a small weight."""
    wave_speed = math.sqrt(vox.youngs_modulus / vox.density)
    slender = 0.1615 * body.shape[2] / (body.shape[0] - 0.5) ** 2 * wave_speed / vox.voxel_size
    swinging = attrs.evolve(
        vox,
        gravity=-1e-6 * wave_speed**2 / vox.voxel_size,
        expansion_coefficient=0.0,
        slow_damping=0.0,
        self_collision=False,
        duration=3.0 / slender,
    )
    design = Design({MORPHOLOGY: body, CONTROLLER: np.zeros(body.shape)})
    [outcome] = swinging.simulate([design], Record(("face",)))
    height = outcome.tracks["face"][:, 2]
    low = np.flatnonzero((height[1:-1] < height[:-2]) & (height[1:-1] < height[2:])) + 1
    deep = low[height[low] < height.mean()]
    return float(1.0 / (outcome.times[deep[1]] - outcome.times[deep[0]]))


def bending(vox: Any, objective: Any, design: Design) -> tuple[float, float]:
    """Return the displacement in voxel edges, and the CPU time of the simulation, s."""
    started = time.process_time()
    [outcome] = vox.simulate([design], objective.record)
    cpu = time.process_time() - started
    return objective.score(outcome) / vox.voxel_size, cpu


def driven_at(vox: Any, objective: Any, frequency: float) -> tuple[Any, Any]:
    """Return simulator and objective for another drive frequency, with the same number of periods."""
    slower = vox.frequency / frequency
    simulator = attrs.evolve(vox, frequency=frequency, ramp=vox.ramp * slower, duration=vox.duration * slower)
    return simulator, attrs.evolve(objective, every=objective.every * slower, after=objective.after * slower)


def write_line(line: str) -> None:
    """Write a line without buffering, since the next measurement may take a while."""
    sys.stdout.write(f"{line}\n")
    sys.stdout.flush()


def main() -> None:
    """Print the tables."""
    config = evoframe.load_config("bending")
    vox: Any = config.simulator.component
    objective: Any = config.objective.component
    canvas = config.populations[MORPHOLOGY].encoder.component.canvas  # type: ignore[attr-defined]  # of cppn-morphology
    for name, inside in (("solid", PASSIVE), ("enclosure only", 0)):
        mode = first_mode(vox, bar(canvas, inside))
        write_line(
            f"first bending mode, {name}: {mode:.2f} Hz; the drive is at {vox.frequency / mode:.2f} of it"
        )
    displacement, cpu = bending(vox, objective, bimorph(canvas))
    write_line(f"bimorph: {displacement:.3f} voxel edges; {cpu:.2f} s of CPU")
    workers = config.executor.component.start()
    for finding in verify_design(vox, objective, bimorph(canvas), workers).findings:
        least, greatest = (value / vox.voxel_size for value in (finding.values[0], finding.values[-1]))
        write_line(f"  {finding.name}: {least:.7f} to {greatest:.7f} in {len(finding.values)}")
    workers.close()
    for frequency in FREQUENCIES:
        displacement, _ = bending(*driven_at(vox, objective, frequency), bimorph(canvas))
        write_line(f"drive {frequency:g} Hz: {displacement:.3f} voxel edges")
    for damping in DAMPINGS:
        displacement, _ = bending(attrs.evolve(vox, slow_damping=damping), objective, bimorph(canvas))
        write_line(f"slow damping {damping:g}: {displacement:.3f} voxel edges")


if __name__ == "__main__":
    main()
