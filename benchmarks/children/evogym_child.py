"""Program that simulates robots with EvoGym, for the section ``peers`` of ``python -m benchmarks``.

It runs with the old Python that EvoGym requires.
"""

from __future__ import annotations

import importlib.metadata
import math
import time
from typing import Any

import numpy as np
from evogym import EvoSim, EvoWorld, get_full_connectivity

from serving import serve

_RIGID, _FIXED, _ACTUATOR = 1, 5, 3  # of voxels; the actuator is horizontal
_UPDATES, _UPDATE = 30, 1e-4  # in a step of EvoGym: number of updates, and simulated time of each, s
_AMPLITUDE, _PERIOD = 0.2, 25  # of the actuation: fraction of the length, and number of steps
_ROBOT = "robot"

_simulations: list[Any] = []


def prepare(width: int, height: int) -> dict[str, Any]:
    """Create a robot with a rigid outermost layer on flat ground."""
    body = np.full((height, width), _RIGID)
    body[1:-1, 1:-1] = _ACTUATOR
    world = EvoWorld()
    world.add_from_array(_ROBOT, body, width, 1, connections=get_full_connectivity(body))
    world.add_from_array("ground", np.full((1, 3 * width), _FIXED), 0, 0)
    _simulations[:] = [EvoSim(world)]
    return {"version": importlib.metadata.version("evogym"), "time_step": _UPDATE}


def measure(steps: int) -> float:
    """Return the CPU time of a simulated second, s, measured for a number of steps from the initial state."""
    [simulation] = _simulations
    simulation.reset()
    actuators = np.ones(simulation.get_dim_action_space(_ROBOT))
    began = time.process_time()
    for step in range(steps):
        stretch = 1.0 + _AMPLITUDE * math.sin(2.0 * math.pi * step / _PERIOD)
        simulation.set_action(_ROBOT, stretch * actuators)
        if simulation.step():
            raise ValueError("the robot collides with itself, which ends a step early")
    return (time.process_time() - began) / (steps * _UPDATES * _UPDATE)


if __name__ == "__main__":
    serve({"prepare": prepare, "measure": measure})
