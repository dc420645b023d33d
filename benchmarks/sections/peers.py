"""Speed of evoframe compared with programs that users could choose instead."""

from __future__ import annotations

import functools
import importlib.util
import math
import os
import statistics
import sys
from collections.abc import Callable, Sequence
from typing import Any

import attrs

import evoframe
from benchmarks.child import CHILDREN, Child, started
from benchmarks.pairs import alternated
from benchmarks.report import Row, Section, SectionError, Table
from benchmarks.sections.networks import networks
from benchmarks.subjects import bonds_of, canvas, objective, solid, traveler, vox
from benchmarks.timing import Effort, timed
from evoframe import MORPHOLOGY, Design
from evoframe_simulators.vox import model_of

__all__ = ["peers"]

_DURATION = 0.5  # s of simulated time of MuJoCo; simulations of evoframe have the duration of their preset
_LONGEST = 4.0  # largest time step that is tried, in time steps of evoframe
_SIZE = (18, 12)  # of EvoGym: as many as voxels in the canvas of the preset locomotion
_STEPS = 50  # of EvoGym: 0.15 s
_INSTALLING_EVOGYM = (
    "EvoGym requires Python 3.7 to 3.10: create an environment with it, install evogym there, and set "
    "EVOGYM_PYTHON to its interpreter"
)


@attrs.frozen
class _Simulation:
    """A way to simulate a body.

    Attributes:
        name: Its name.
        elements: Number of elements of the body: bonds, tetrahedra or voxels.
        time_step: Simulated time of a step, s.
        cost: Measures the CPU time of a simulated second, s.
        baseline: Name of the simulation with evoframe that it is compared with.
    """

    name: str
    elements: int
    time_step: float
    cost: Callable[[], float]
    baseline: str


def peers(effort: Effort) -> Section:
    """Compare soft bodies with those of MuJoCo and EvoGym, and networks with those of neat-python."""
    tables: list[Table] = []
    missing: list[Row] = []
    for name, compared in {"MuJoCo": _mujoco, "EvoGym": _evogym}.items():
        try:
            tables.append(compared(effort))
        except SectionError as error:
            missing.append((name, str(error)))
    tables += networks(effort).tables
    if missing:
        tables.append(Table("Not measured", ("program", "reason"), missing))
    return Section("evoframe compared with other programs", tuple(tables))


# ---- MuJoCo


def _mujoco(effort: Effort) -> Table:
    if importlib.util.find_spec("mujoco") is None:
        raise SectionError("not installed; install it with: python -m pip install --group peers")
    with started("MuJoCo", _command(sys.executable, "mujoco_child.py"), {}) as child:
        alone = _evaluation("evoframe", "paper", solid(), effort, self_collision=False)
        contacts = _evaluation("evoframe, contacts", "paper", solid(), effort)
        bar = functools.partial(_bar, child, alone.time_step)
        sampling: Any = objective()
        explicit = bar("MuJoCo, explicit", alone, "Euler", "none")
        implicit = bar("MuJoCo, implicit", alone, "discrete", "none", sampling.every)
        colliding = bar("MuJoCo, contacts", contacts, "Euler", "auto")
        about = child.ask("about", name=explicit.name)
        size = " x ".join(map(str, canvas()))
        return _table(
            f"A bar of {size} voxels, compared with a flex of MuJoCo {about['version']}",
            math.prod(canvas()),
            (alone, explicit, implicit, contacts, colliding),
            effort,
            "One end is fixed; both have the same material; contacts are those of the body with itself. "
            "Elements are bonds, and tetrahedra (six for each voxel). The step is 0.9 times the largest "
            "stable one; with the implicit integrator, the interval of the samples. Not comparable: "
            "tetrahedra are finite elements, without rotations of voxels and without damping; the bar of "
            "MuJoCo swings, since a flex cannot contract. MuJoCo also compiles each body in "
            f"{about['compiling']:.2g} s, while evoframe keeps the bodies that it simulates again.",
        )


def _bar(  # noqa: PLR0913, PLR0917 - the settings of a simulation
    child: Child,
    usual: float,
    name: str,
    baseline: _Simulation,
    integrator: str,
    self_collision: str,
    time_step: float | None = None,
) -> _Simulation:
    """Return a simulation with MuJoCo; without a time step, it has 0.9 times the largest stable one."""
    prepared = child.ask(
        "prepare",
        name=name,
        time_step=time_step,
        longest=_LONGEST * usual,
        canvas=canvas(),
        edge=vox().voxel_size,
        density=vox().density,
        youngs_modulus=vox().youngs_modulus,
        poisson_ratio=vox().poisson_ratio,
        integrator=integrator,
        self_collision=self_collision,
    )
    cost = functools.partial(child.ask, "measure", name=name, duration=_DURATION)
    return _Simulation(name, prepared["elements"], prepared["time_step"], cost, baseline.name)


# ---- EvoGym


def _evogym(effort: Effort) -> Table:
    interpreter = os.environ.get("EVOGYM_PYTHON") or sys.executable
    if interpreter == sys.executable and importlib.util.find_spec("evogym") is None:
        raise SectionError(f"not installed; {_INSTALLING_EVOGYM}")
    body = traveler(evoframe.load_config("locomotion").populations[MORPHOLOGY].encoder.component.canvas)  # type: ignore[attr-defined]  # of cppn-morphology
    cube = _evaluation("evoframe, preset locomotion", "locomotion", body, effort)
    with started("EvoGym", _command(interpreter, "evogym_child.py"), {}) as child:
        width, height = _SIZE
        prepared = child.ask("prepare", width=width, height=height)
        cost = functools.partial(child.ask, "measure", steps=_STEPS)
        robot = _Simulation("EvoGym", width * height, prepared["time_step"], cost, cube.name)
        return _table(
            f"A robot of {width * height} voxels on a floor, compared with EvoGym {prepared['version']}",
            width * height,
            (cube, robot),
            effort,
            f"A cube in three dimensions, and {width} x {height} voxels in two. Elements are bonds, and "
            "voxels. Both have gravity, friction, contacts and their usual step. Not comparable: EvoGym has "
            "masses at the corners of squares, connected by springs, and four evaluations of all forces in a "
            "step; size and stiffness of voxels differ, so that the same second contains other motions.",
        )


def _command(interpreter: str, program: str) -> list[str]:
    return [interpreter, str(CHILDREN / program)]


# ---- both


def _evaluation(name: str, preset: str, design: Design, effort: Effort, **changes: Any) -> _Simulation:
    """Return the simulation and scoring of a design with the settings of a preset, except for *changes*."""
    config = evoframe.load_config(preset)
    simulator: Any = attrs.evolve(config.simulator.component, **changes)  # type: ignore[misc]  # of vox
    score, record = config.objective.component.score, config.objective.component.record
    body = design.roles[MORPHOLOGY]
    steps, numbers = model_of(simulator, body.shape).time_steps(body[None])
    duration = float(steps[0] * numbers[0])
    measure = timed(lambda: [score(outcome) for outcome in simulator.simulate([design], record)], effort)
    return _Simulation(name, bonds_of(design), float(steps[0]), lambda: measure() / duration, name)


def _table(title: str, voxels: int, simulations: Sequence[_Simulation], effort: Effort, note: str) -> Table:
    taken = alternated({simulation.name: simulation.cost for simulation in simulations}, effort.rounds)
    seconds = {name: statistics.median(values) for name, values in taken.items()}
    steps = {each.name: 1e9 * seconds[each.name] * each.time_step for each in simulations}
    rows: list[Row] = [
        (
            each.name,
            each.elements,
            1e3 * each.time_step,
            steps[each.name] / each.elements,
            steps[each.name] / voxels,
            steps[each.name] / steps[each.baseline],
            seconds[each.name],
            seconds[each.name] / seconds[each.baseline],
        )
        for each in simulations
    ]
    return Table(
        title,
        (
            *("", "elements", "step, ms", "ns per element-step", "ns per voxel-step", "ratio of steps"),
            *("CPU s per simulated s", "ratio of seconds"),
        ),
        rows,
        f"Ratios: to evoframe, with the same contacts. {note}",
    )
