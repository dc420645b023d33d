"""Program that simulates soft bars with MuJoCo, for the section ``peers`` of ``python -m benchmarks``."""

from __future__ import annotations

import math
import time
from typing import Any

import mujoco
import numpy as np

from serving import serve

_MODEL = """
<mujoco>
  <option timestep="{time_step}" gravity="0 0 0" integrator="{integrator}"/>
  <size memory="1G"/>
  <worldbody>
    <flexcomp name="bar" type="grid" dim="3" count="{count}" spacing="{edge} {edge} {edge}" radius="{radius}"
              mass="{mass}">
      <elasticity young="{youngs_modulus}" poisson="{poisson_ratio}"/>
      <contact selfcollide="{self_collision}"/>
      <pin gridrange="0 0 0 0 {last_y} {last_z}"/>
    </flexcomp>
  </worldbody>
</mujoco>
"""
_RADIUS = 0.02  # of vertices, in voxel edges; affects contacts only
_SPEED = 0.2  # m/s, of the free end; the body swings as it cannot contract
_NOISE = 0.02  # m/s, so that all modes of the body are excited
_TOO_FAST = 10.0  # m/s; the body is unstable
_TRIAL = 1.0  # s of simulated time in which a stable body remains slow
_STEPS_PER_OCTAVE = 4  # of trials for the largest stable time step
_MARGIN = 0.9  # of the largest stable time step, as in the simulator vox

_bars: dict[str, tuple[Any, Any]] = {}
_compiling: dict[str, float] = {}


def prepare(name: str, time_step: float | None, longest: float, **settings: Any) -> dict[str, Any]:
    """Create a bar that is fixed at one end.

    Args:
        name: Its name in :func:`measure`.
        time_step: Its time step, s; ``None``: 0.9 times the largest stable one.
        longest: The largest time step to try, s.
        **settings: Canvas, material and computation: see :func:`_compiled`.
    """
    if time_step is None:
        time_step = _MARGIN * _largest_stable(longest, settings)
    began = time.process_time()
    model = _compiled(time_step, **settings)
    _compiling[name] = time.process_time() - began
    _bars[name] = model, mujoco.MjData(model)
    return {"elements": int(model.nflexelem), "time_step": time_step}


def about(name: str) -> dict[str, Any]:
    """Return the version of MuJoCo, and the time that it took to compile a bar, s."""
    return {"version": mujoco.__version__, "compiling": _compiling[name]}


def measure(name: str, duration: float) -> float:
    """Return the CPU time of a simulated second, s, measured for a duration, s, from the initial state."""
    model, data = _bars[name]
    time_step = float(model.opt.timestep)
    steps = math.ceil(duration / time_step)
    _start(model, data)
    began = time.process_time()
    for _ in range(steps):
        mujoco.mj_step(model, data)
    taken = time.process_time() - began
    if not _is_slow(data):
        raise ValueError(f"{name} is unstable")
    return taken / (steps * time_step)


def _compiled(  # noqa: PLR0913 - the settings of a bar
    time_step: float,
    *,
    canvas: list[int],
    edge: float,
    density: float,
    youngs_modulus: float,
    poisson_ratio: float,
    integrator: str,
    self_collision: str,
) -> Any:
    """Return the model of a bar in which each voxel is a cell of six tetrahedra."""
    return mujoco.MjModel.from_xml_string(
        _MODEL.format(
            time_step=time_step,
            integrator=integrator,
            count=" ".join(str(n + 1) for n in canvas),
            edge=edge,
            radius=_RADIUS * edge,
            mass=density * edge**3 * math.prod(canvas),
            youngs_modulus=youngs_modulus,
            poisson_ratio=poisson_ratio,
            self_collision=self_collision,
            last_y=canvas[1],
            last_z=canvas[2],
        )
    )


def _largest_stable(longest: float, settings: dict[str, Any]) -> float:
    time_step = longest
    while not _is_stable(_compiled(time_step, **settings)):
        time_step *= 2.0 ** (-1.0 / _STEPS_PER_OCTAVE)
    return time_step


def _is_stable(model: Any) -> bool:
    data = mujoco.MjData(model)
    _start(model, data)
    for _ in range(math.ceil(_TRIAL / model.opt.timestep)):
        mujoco.mj_step(model, data)
        if not _is_slow(data):
            return False
    return True


def _start(model: Any, data: Any) -> None:
    """Set the initial state: the free end moves along z, and all vertices move a little."""
    mujoco.mj_resetData(model, data)
    mujoco.mj_forward(model, data)
    free = model.body_dofnum[model.flex_vertbodyid] == 3  # fixed vertices have no degrees of freedom
    x = data.flexvert_xpos[free, 0]
    along = (x - x.min()) / (x.max() - x.min())
    data.qvel[:] = _NOISE * np.random.default_rng(1).standard_normal(model.nv)
    data.qvel[model.body_dofadr[model.flex_vertbodyid[free]] + 2] += _SPEED * along**2


def _is_slow(data: Any) -> bool:
    return bool(np.abs(data.qvel).max() < _TOO_FAST)


if __name__ == "__main__":
    serve({"prepare": prepare, "about": about, "measure": measure})
