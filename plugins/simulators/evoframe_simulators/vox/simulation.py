"""Simulation of batches: one solver call for designs of the same canvas and number of samples."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence

import attrs
import numpy as np
from numpy.typing import NDArray

from evoframe import MORPHOLOGY, Design, InputError, Outcome, Record
from evoframe_simulators.vox.bodies import check_codes, check_design
from evoframe_simulators.vox.models import Canvas, clock_of, model_of, strip_body_index
from evoframe_simulators.vox.sampling import Clock
from evoframe_simulators.vox.settings import VoxSettings, materials_of, phase_cycles
from evoframe_simulators.vox.tracks import FURTHER, POINTS, check_size, shape_of

__all__ = ["simulate"]


def simulate(settings: VoxSettings, designs: Sequence[Design], record: Record) -> list[Outcome]:
    """Return the outcome of each design, in order; a design without voxels counts as diverged at step 0.

    Raises:
        InputError: A design is not a body with a controller, or its record would be too large.
    """
    outcomes: dict[int, Outcome] = {}
    canvases: dict[Canvas, dict[int, Design]] = defaultdict(dict)
    for index, design in enumerate(designs):
        check_design(design)
        material = design.roles[MORPHOLOGY]
        x, y, z = material.shape
        if material.any():
            canvases[x, y, z][index] = design
        else:
            nothing = {track: np.zeros((0, *shape_of(track, (x, y, z)))) for track in record.tracks}
            outcomes[index] = Outcome(np.zeros(0, np.int64), np.zeros(0), nothing, diverged_at=0)
    for canvas, group in canvases.items():
        try:
            outcomes |= _on_canvas(settings, canvas, group, record)
        except ValueError as error:  # the solver rejects the values of cells
            for design in group.values():  # its message does not contain the unknown code
                check_codes(design.roles[MORPHOLOGY], materials_of(settings))
            raise InputError(strip_body_index(error)) from error
    return [outcomes[index] for index in range(len(designs))]


def _on_canvas(
    settings: VoxSettings, canvas: Canvas, designs: Mapping[int, Design], record: Record
) -> dict[int, Outcome]:
    """Simulate designs on one canvas, in one solver call for each number of samples."""
    taken: dict[Clock, _Samples] = {}
    batches: dict[int, dict[int, _Samples]] = defaultdict(dict)
    for index, design in designs.items():
        clock = clock_of(settings, design.roles[MORPHOLOGY])
        samples = taken.get(clock) or taken.setdefault(clock, _Samples.of(clock, record))
        batches[len(samples.steps)][index] = samples
    tracks = tuple(track for track in (*POINTS, *FURTHER) if track in record.tracks)
    outcomes: dict[int, Outcome] = {}
    for count, batch in batches.items():
        check_size(tracks, canvas, count)
        result = model_of(settings, canvas).simulate(
            np.array([designs[index].roles[MORPHOLOGY] for index in batch]),
            np.array([phase_cycles(settings, designs[index]) for index in batch]),
            np.array([samples.steps for samples in batch.values()]),
            tracks,
        )
        diverged_at = result.diverged_step.tolist()
        for place, (index, samples) in enumerate(batch.items()):
            outcomes[index] = Outcome(
                steps=samples.steps,
                times=samples.times,
                tracks={name: track[place] for name, track in result.tracks.items()},
                diverged_at=diverged_at[place] or None,
            )
    return outcomes


@attrs.frozen(eq=False)
class _Samples:
    """The samples of bodies with the same clock; their arrays are read-only."""

    steps: NDArray[np.int64]
    times: NDArray[np.float64]

    @classmethod
    def of(cls, clock: Clock, record: Record) -> _Samples:
        steps = clock.samples(record)
        times = steps * np.float64(clock.time_step)
        times.setflags(write=False)
        return cls(steps, times)
