"""Random controllers."""

from __future__ import annotations

import math

import numpy as np
import pytest
import toys
from hypothesis import given, strategies as st

from evoframe import CONTROLLER, MORPHOLOGY, ConfigurationError, Design
from evoframe.testing import RoleProviderContract
from evoframe_roles import RandomController
from evoframe_simulators.vox import Vox

BODY = Design({MORPHOLOGY: np.full((3, 2, 2), 3, np.uint8)})


class TestRandomController(RoleProviderContract):
    component = RandomController()
    simulator = Vox()

    def design(self) -> Design:
        return BODY


@given(seed=st.integers(0, 2**32 - 1))
def test_it_is_the_random_controller_of_the_simulator(seed: int) -> None:
    drawn = RandomController().start(Vox()).fill(BODY, np.random.default_rng(seed))
    expected = np.random.default_rng(seed).uniform(-math.tau, math.tau, (3, 2, 2))
    np.testing.assert_array_equal(drawn.roles[CONTROLLER], expected)
    assert drawn.roles[MORPHOLOGY] is BODY.roles[MORPHOLOGY]


def test_bodies_of_one_canvas_get_the_same_controller_from_the_same_state() -> None:
    run = RandomController().start(Vox())
    other = Design({MORPHOLOGY: np.ones((3, 2, 2), np.uint8)})
    one, two = (run.fill(body, np.random.default_rng(4)).roles[CONTROLLER] for body in (BODY, other))
    np.testing.assert_array_equal(one, two)


def test_a_simulator_without_random_controllers_is_refused_by_name() -> None:
    with pytest.raises(ConfigurationError, match="Product draws no random controllers"):
        RandomController().start(toys.Product())
