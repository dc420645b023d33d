"""Memory of the bodies that a model keeps for later calls."""

import sys

import pytest
from processes import python

MOST = 80  # MB: 32 MiB of kept bodies, and the one in use

# Bodies with many near pairs, whose lists are larger than all other arrays.
PROGRAM = """
import resource

import numpy as np

from evoframe_libvox import Material, Model, Settings

shape = (24, 24, 24)
settings = Settings(voxel_size=0.05, duration=1e-9, temperature_amplitude=0.0, period=1.0,
    collision_horizon=6.0)
model = Model(shape, {1: Material(5e6, 0.35, 1e6, 0.0)}, settings, np.zeros(shape, np.uint8))
rng = np.random.default_rng(0)
before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
for _ in range(8):
    body = (rng.random((1, *shape)) < 0.5).astype(np.uint8)
    model.simulate(body, np.zeros(body.shape), [[1]], ["tip"])
print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="the unit of ru_maxrss differs")
def test_kept_bodies_have_a_limit_with_their_contacts() -> None:
    ran = python("-c", PROGRAM)
    assert ran.returncode == 0, ran.stderr
    assert int(ran.stdout) / 1000 < MOST
