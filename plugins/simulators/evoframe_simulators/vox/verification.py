"""Variants of a simulation that show whether a score is an artifact, for ``evoframe verify``."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TypeVar

import attrs
import numpy as np

import evoframe_libvox as libvox
from evoframe import CONTROLLER, MORPHOLOGY, Design, Record
from evoframe_simulators.vox.limits import MOST_STEPS
from evoframe_simulators.vox.models import clock_of
from evoframe_simulators.vox.settings import VoxSettings

__all__ = ["MEANINGS", "changes"]

S = TypeVar("S", bound=VoxSettings)

_DRAWS = 10
_JITTER = 0.01
MEANINGS: Mapping[str, tuple[str, str]] = {
    "contraction off": ("does not come from contraction", "comes from contraction"),
    "self collision off": ("does not depend on self collision", "depends on self collision"),
    "half the time step": ("does not depend on the time step", "depends on the time step"),
    "twice the duration": (
        "is kept over twice the duration",
        "is not kept over twice the duration: it is a moment, not a posture",
    ),
    "offsets jittered by 1 %": ("tolerates errors of the offsets", "needs exact offsets"),
}
"""Name of a change -> interpretation if the score is kept, and if it is lost."""

_SEED = 20251024  # of all jitter, so that a verification is reproducible


def changes(settings: S, design: Design, record: Record) -> Iterator[tuple[str, S, Design, Record]]:
    """Yield simulations that differ from the original in one way: name, settings, design and record.

    With twice the duration, samples are taken at exactly twice the instants: step n of the original becomes
    step 2n, for any interval of the record. A record of all samples yields more of them in the longer
    simulation. Half the time step is obtained by doubling the substeps, so that the sampled instants do not
    change; it is omitted if the solver cannot divide the step further.

    Args:
        settings: Settings of the original simulation; the yielded settings have the same class.
        design: A body with its controller.
        record: Record of the original simulation.

    Raises:
        ValueError: The solver rejects the changed settings or the body.
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
    """Return settings without thermal expansion."""
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
    last = clock_of(longer, material).steps  # twice the steps, or one fewer
    samples = tuple(min(2 * step, last) - 1 for step in steps.tolist())
    # The original record reached its "until", so this one does as well; the instants of other bodies, which
    # differ, are irrelevant here.
    return attrs.evolve(record, every=0.0, samples=samples, until=0.0)
