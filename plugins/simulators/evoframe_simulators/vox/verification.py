"""What a design is compared with, to see whether its score is real (paper.md, ``evoframe verify``)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TypeVar

import attrs
import numpy as np

import evoframe_libvox as libvox
from evoframe import CONTROLLER, MORPHOLOGY, Design, Record
from evoframe_simulators.vox.limits import MOST_STEPS
from evoframe_simulators.vox.models import clock_of
from evoframe_simulators.vox.settings import VoxSettings

__all__ = ["changes"]

S = TypeVar("S", bound=VoxSettings)

_DRAWS = 10
_JITTER = 0.01
_SEED = 20251024  # of all jitter, so that a verification can be repeated


def changes(settings: S, design: Design, record: Record) -> Iterator[tuple[str, S, Design, Record]]:
    """Yield the design's simulations with one thing changed in each: its name, and what is simulated how.

    Twice the duration is sampled at twice the instants, to the step: the n-th step of the design becomes its
    2n-th, whatever the interval of the record. Where the record takes every sample that there is, the longer
    simulation gives more of them. Half the time step is left out where the solver cannot divide it further;
    it is made by twice the substeps, so that the instants stay the same.

    Args:
        settings: Simulate the design; those that are yielded are of the same class.
        design: A body with its controller.
        record: What is recorded of the unchanged simulation.

    Raises:
        ValueError: The solver cannot work with the changed settings, or with the body; says why.
    """
    limit = min(2 * settings.step_limit, MOST_STEPS)
    longer = attrs.evolve(settings, duration=2 * settings.duration, step_limit=limit)
    yield "contraction off", _still(settings), design, record
    yield "self collision off", attrs.evolve(settings, self_collision=False), design, record
    if 2 * settings.substeps in libvox.SETTING_RANGES["substeps"]:
        finer = attrs.evolve(settings, substeps=2 * settings.substeps, step_limit=limit)
        yield "half the time step", finer, design, record
    yield "twice the duration", longer, design, _later(settings, longer, design, record)
    random, offsets = np.random.default_rng(_SEED), design.roles[CONTROLLER]
    for _ in range(_DRAWS):
        factors = 1.0 + random.uniform(-_JITTER, _JITTER, offsets.shape)
        yield "offsets jittered by 1 %", settings, design.with_role(CONTROLLER, offsets * factors), record


def _still(settings: S) -> S:
    """Return settings in which no material expands."""
    if not settings.palette:
        return attrs.evolve(settings, expansion_coefficient=0.0)
    palette = tuple(attrs.evolve(material, expansion_coefficient=0.0) for material in settings.palette)
    return attrs.evolve(settings, palette=palette)


def _later(settings: VoxSettings, longer: VoxSettings, design: Design, record: Record) -> Record:
    """Return the record with its samples at twice the instants."""
    material = design.roles[MORPHOLOGY]
    if record.samples is None or not material.any():
        return record
    steps = clock_of(settings, material).nominal(attrs.evolve(record, initial=False))
    last = clock_of(longer, material).steps  # twice the steps, or one less
    samples = tuple(min(2 * step, last) - 1 for step in steps.tolist())
    # What must be reached is reached, as the record could be delivered before; other bodies, which have other
    # instants, do not matter here.
    return attrs.evolve(record, every=0.0, samples=samples, until=0.0)
