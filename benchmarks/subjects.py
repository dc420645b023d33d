"""Subjects of the benchmarks: the paper's setting, its published bodies, and random bodies."""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any, cast

import attrs
import numpy as np
from numpy.typing import NDArray

import evoframe
from benchmarks.timing import Action
from evoframe import CONTRACTILE, CONTROLLER, MORPHOLOGY, PASSIVE, Design, Encoder, Network, Objective
from evoframe_evolvers import RandomSearch
from evoframe_libvox import Model
from evoframe_simulators.vox import Vox, clocks_of, fixed_mask, model_of

__all__ = [
    "bonds_of",
    "canvas",
    "encoder",
    "evaluating",
    "model",
    "objective",
    "published",
    "random_designs",
    "solid",
    "solver",
    "solving",
    "traveler",
    "vox",
]

_SEED = 1
_MUTATIONS = 10  # of a random network, at most
_PUBLISHED = Path(__file__).parent.parent / "tests" / "data" / "paper_preset.npz"


@functools.cache
def _paper() -> evoframe.RunConfig:
    return evoframe.load_config("paper")


def vox() -> Vox:
    """Return the simulator of the preset ``paper``."""
    return cast("Vox", _paper().simulator.component)


def objective() -> Objective:
    """Return the objective of the preset ``paper``."""
    return _paper().objective.component


def encoder(role: str) -> Encoder:
    """Return the encoder of a population of the preset ``paper``."""
    return _paper().populations[role].encoder.component


def canvas() -> tuple[int, int, int]:
    """Return the canvas of the preset ``paper``: 20 x 8 x 8 voxels."""
    x, y, z = solid().roles[MORPHOLOGY].shape
    return x, y, z


def model(
    *, kernel: str | None = None, whole_body: bool = False, passive: bool = False, **changes: Any
) -> Model:
    """Return the solver's model of the paper's setting.

    Args:
        kernel: Name of the kernel; by default the fastest.
        whole_body: Whether to compute the voxels that can no longer affect a sample too.
        passive: Whether to disable all contraction.
        **changes: Other settings of the solver.
    """
    simulator = attrs.evolve(vox(), expansion_coefficient=0.0) if passive else vox()
    return solver(simulator, kernel=kernel, whole_body=whole_body, **changes)


def solver(simulator: Vox, *, kernel: str | None, whole_body: bool, **changes: Any) -> Model:
    """Return the solver's model of a simulator on the canvas of ``paper``, as :func:`model`."""
    usual = model_of(simulator, canvas())
    return Model(
        usual.canvas,
        usual.palette,
        attrs.evolve(usual.settings, **changes),
        fixed_mask(simulator.fixed, canvas()),
        kernel=kernel,
        whole_body=whole_body,
    )


@functools.cache
def solid() -> Design:
    """Return the bar whose interior voxels all contract, in a wave along x."""
    body = encoder(MORPHOLOGY).decode(lambda points: np.ones((len(points), 2)), Design())
    material = body.roles[MORPHOLOGY]
    if not np.isin(material, (PASSIVE, CONTRACTILE)).all():
        raise AssertionError("the bar has holes")
    wave = np.linspace(0.0, 1.0, material.shape[0])[:, None, None]
    return body.with_role(CONTROLLER, np.broadcast_to(wave, material.shape).copy())


def traveler(canvas: Sequence[int]) -> Design:
    """Return a solid body that contracts in a wave along x, with offsets in radians."""
    body = np.full(canvas, CONTRACTILE, np.uint8)
    wave = np.linspace(0.0, 2.0 * math.pi, canvas[0])[:, None, None]
    return Design({MORPHOLOGY: body, CONTROLLER: np.broadcast_to(wave, body.shape).copy()})


@functools.cache
def published() -> dict[str, Design]:
    """Return the published bodies with each of their offsets by name, such as ``HyperNEAT, sin offsets``."""
    with np.load(_PUBLISHED) as arrays:
        rows = zip(arrays["label"].tolist(), arrays["material"], arrays["phase_cycles"], strict=True)
        return {
            label.removeprefix("published "): Design({MORPHOLOGY: material, CONTROLLER: phase})
            for label, material, phase in rows
            if label.startswith("published ")
        }


def random_designs(bodies: int, controllers: int) -> list[list[Design]]:
    """Return random bodies, all with the same random controllers, drawn by the evolver ``random``."""
    drawn = [encoder(MORPHOLOGY).decode(network, Design()) for network in _networks(MORPHOLOGY, bodies)]
    networks = _networks(CONTROLLER, controllers)
    return [[encoder(CONTROLLER).decode(network, body) for network in networks] for body in drawn]


def _networks(role: str, count: int) -> list[Network]:
    ends = encoder(role).inputs, encoder(role).outputs
    evolver = RandomSearch(mutations=_MUTATIONS).start(*ends, count, np.random.default_rng(_SEED))
    return [evolver.express(genome) for genome in evolver.ask()]


def bonds_of(design: Design) -> int:
    """Return the number of bonds of a body: pairs of voxels that share a face."""
    there = design.roles[MORPHOLOGY] != 0
    pairs = ((there[1:], there[:-1]), (there[:, 1:], there[:, :-1]), (there[..., 1:], there[..., :-1]))
    return sum(int((lower & upper).sum()) for lower, upper in pairs)


def solving(of: Model, designs: Sequence[Design]) -> Action:
    """Return a call of the solver that simulates designs with the samples of the paper's objective."""
    material: NDArray[np.uint8] = np.stack([design.roles[MORPHOLOGY] for design in designs])
    phase: NDArray[np.float64] = np.stack([design.roles[CONTROLLER] for design in designs])
    record = objective().record
    steps = np.stack([clock.samples(record) for clock in clocks_of(vox(), of, material)])
    return lambda: of.simulate(material, phase, steps, ["tip"])


def evaluating(simulator: Vox, designs: Sequence[Design]) -> Action:
    """Return the evaluation of designs as in a run: simulation and scoring."""
    record = objective().record
    return lambda: [objective().score(outcome) for outcome in simulator.simulate(designs, record)]
