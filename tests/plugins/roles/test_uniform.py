"""Roles with the same value everywhere."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
import toys
from hypothesis import given, strategies as st

from evoframe import CONTROLLER, MORPHOLOGY, Design
from evoframe.testing import RoleProviderContract
from evoframe_roles import Uniform

BODY = Design({MORPHOLOGY: np.array([[[0, 1], [3, 3]]], np.uint8)})


class TestController(RoleProviderContract):
    component = Uniform(value=0.25)
    simulator = toys.Product()

    def design(self) -> Design:
        return BODY


class TestMorphology(RoleProviderContract):
    component = Uniform(role=MORPHOLOGY, value=3, dtype="uint8", shape=(4, 2, 2))
    simulator = toys.Product()


def filled(provider: Uniform, design: Design = BODY) -> Any:
    return provider.start(toys.Product()).fill(design, np.random.default_rng(0)).roles[provider.role]


@given(value=st.floats(-1e9, 1e9), shape=st.lists(st.integers(1, 4), min_size=1, max_size=3).map(tuple))
def test_the_array_has_the_value_the_type_and_the_shape(value: float, shape: tuple[int, ...]) -> None:
    array = filled(Uniform(value=value, shape=shape), Design())
    assert (array.shape, array.dtype) == (shape, np.float64)
    assert set(array.ravel().tolist()) == {value}


def test_without_a_shape_it_has_that_of_another_role() -> None:
    assert Uniform().requires == (MORPHOLOGY,)
    assert filled(Uniform()).shape == (1, 2, 2)
    assert Uniform(like="other").requires == ("other",)


def test_with_a_shape_it_requires_nothing() -> None:
    assert Uniform(shape=(2,)).requires == ()
    assert Uniform(shape=(2,)).provides == (CONTROLLER,)


def test_a_body_is_made_of_codes() -> None:
    array = filled(Uniform(role=MORPHOLOGY, value=3, dtype="uint8", shape=(2, 1, 1)), Design())
    assert array.dtype == np.uint8
    assert array.tolist() == [[[3]], [[3]]]


@pytest.mark.parametrize("value", [0.5, -1, 256, math.pi])
def test_a_code_is_a_whole_number_up_to_255(value: float) -> None:
    with pytest.raises(ValueError, match=f"0 to 255 .*{value}"):
        Uniform(value=value, dtype="uint8")


@pytest.mark.parametrize("shape", [(0,), (2, -1)])
def test_a_shape_has_positive_lengths(shape: tuple[int, ...]) -> None:
    with pytest.raises(ValueError, match="'shape' must have lengths of at least 1"):
        Uniform(shape=shape)
