"""Contract tests of the thrown balls, and examples."""

import math
from collections.abc import Sequence

import numpy as np
import pytest
from acme_no_voxels import Ballistics, Nearness, Throw

from evoframe import Design, Record
from evoframe.testing import EncoderContract, ObjectiveContract, SimulatorContract


def thrown(angle: float, speed: float) -> Design:
    return Design({"throw": np.array([angle, speed])})


class TestThrow(EncoderContract):
    component = Throw()


class TestNearness(ObjectiveContract):
    component = Nearness()


class TestBallistics(SimulatorContract):
    component = Ballistics()

    def designs(self) -> Sequence[Design]:
        # The last two differ, but have equal keys.
        return [thrown(0.5, 1.0), thrown(0.9, 0.3), thrown(0.0, 0.5), thrown(-0.0, 0.5)]


class TestDivergingBallistics(SimulatorContract):
    component = Ballistics(speed=1e3, drag=5.0)

    def designs(self) -> Sequence[Design]:
        return [thrown(0.5, 0.008), thrown(0.9, 0.003), thrown(0.2, 0.005)]

    def diverging(self) -> Sequence[Design]:
        return [thrown(0.5, 1.0), thrown(0.5, math.nan)]


@pytest.mark.parametrize("angle", [0.2, 0.5, 0.7])
def test_without_drag_the_ball_flies_a_parabola(angle: float) -> None:
    simulator = Ballistics(drag=0.0, time_step=1e-3, steps=6000)
    [outcome] = simulator.simulate([thrown(angle, 1.0)], Record(("ball",)))
    expected = 30.0**2 * math.sin(angle * math.pi) / 9.81
    assert outcome.tracks["ball"][-1, 0] == pytest.approx(expected, abs=0.1)
