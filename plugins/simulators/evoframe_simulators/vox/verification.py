"""What a design is compared with, to see whether its score is real (paper.md, ``evoframe verify``)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import attrs
import numpy as np

from evoframe import CONTROLLER, MORPHOLOGY, Design, Record, Variant
from evoframe_simulators.vox.models import clocks_of, model_of

if TYPE_CHECKING:
    from evoframe_simulators.vox.sampling import Clock
    from evoframe_simulators.vox.simulator import Vox

__all__ = ["variants"]

_DRAWS = 10
_JITTER = 0.01
_SEED = 20251024  # of all jitter, so that a verification can be repeated
_MOST_SUBSTEPS = 1000
_MOST_STEPS = 2**53


def variants(vox: Vox, design: Design, record: Record) -> list[Variant]:
    """Return the design's simulations with one thing changed in each.

    Twice the duration is sampled at twice the instants, to the step: the n-th step of the design becomes its
    2n-th, whatever the interval of the record. Where the record takes every sample that there is, the longer
    simulation gives more of them. Half the time step is left out where the solver cannot divide it further.

    Raises:
        InputError: The design is no body with a controller.
    """
    return [
        Variant("contraction off", _still(vox), design, record),
        Variant("self collision off", attrs.evolve(vox, self_collision=False), design, record),
        *(Variant("half the time step", finer, design, record) for finer in _finer(vox)),
        Variant("twice the duration", _longer(vox), design, _later(vox, design, record)),
        *(Variant("offsets jittered by 1 %", vox, jittered, record) for jittered in _jittered(design)),
    ]


def _still(vox: Vox) -> Vox:
    palette = tuple(attrs.evolve(material, expansion_coefficient=0.0) for material in vox.palette)
    own = vox.expansion_coefficient if palette else 0.0
    return attrs.evolve(vox, palette=palette, expansion_coefficient=own)


def _finer(vox: Vox) -> list[Vox]:
    """Return a simulator with half the time step: by twice the substeps, so that instants stay the same."""
    if 2 * vox.substeps > _MOST_SUBSTEPS:
        return []
    return [attrs.evolve(vox, substeps=2 * vox.substeps, step_limit=_doubled_limit(vox))]


def _longer(vox: Vox) -> Vox:
    return attrs.evolve(vox, duration=2 * vox.duration, step_limit=_doubled_limit(vox))


def _doubled_limit(vox: Vox) -> int:
    return min(2 * vox.step_limit, _MOST_STEPS)


def _later(vox: Vox, design: Design, record: Record) -> Record:
    """Return the record with its samples at twice the instants."""
    if record.samples is None or not design.roles[MORPHOLOGY].any():
        return record
    steps = _clock(vox, design).nominal(attrs.evolve(record, initial=False))
    last = _clock(_longer(vox), design).steps  # twice the steps, or one less
    samples = tuple(min(2 * step, last) - 1 for step in steps.tolist())
    # What must be reached is reached, as the record could be delivered before; other bodies, which have other
    # instants, do not matter here.
    return attrs.evolve(record, every=0.0, samples=samples, until=0.0)


def _clock(vox: Vox, design: Design) -> Clock:
    material = design.roles[MORPHOLOGY]
    x, y, z = material.shape
    [clock] = clocks_of(vox, model_of(vox, (x, y, z)), material[None])
    return clock


def _jittered(design: Design) -> Iterator[Design]:
    random = np.random.default_rng(_SEED)
    offsets = design.roles[CONTROLLER]
    for _ in range(_DRAWS):
        factors = 1.0 + random.uniform(-_JITTER, _JITTER, offsets.shape)
        yield design.with_role(CONTROLLER, offsets * factors)
