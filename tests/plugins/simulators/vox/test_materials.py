"""Materials of voxels, and palettes."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import attrs
import numpy as np
import pytest
from bars import bar, soft
from hypothesis import given, settings, strategies as st

import evoframe_libvox as libvox
from evoframe import Record
from evoframe.documents import structure
from evoframe.testing.laws import same_outcome
from evoframe_simulators import Vox
from evoframe_simulators.vox.materials import describe_codes, round_to_single, solver_palette
from evoframe_simulators.vox.models import possible_clocks
from evoframe_simulators.vox.settings import VoxSettings, materials_of


def test_two_materials_with_one_code_are_rejected() -> None:
    with pytest.raises(ValueError, match="found 2 with 4"):
        Vox(palette=(soft(4), soft(2), soft(4)))


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"code": 0}, "'code'.*>= 1"),
        ({"code": 256}, "'code'.*<= 255"),
        ({"youngs_modulus": 0.0}, "'youngs_modulus'.*1e-6 and 1e18 Pa: 0.0"),
        ({"poisson_ratio": 0.6}, "'poisson_ratio'.*0 and 0.5: 0.6"),
        ({"poisson_ratio": -0.1}, "'poisson_ratio'.*0 and 0.5: -0.1"),
        ({"density": -1.0}, "'density'.*1e-6 and 1e18 kg/m3: -1.0"),
        ({"expansion_coefficient": math.inf}, "'expansion_coefficient'.*: inf"),
        ({"static_friction": -1.0}, "'static_friction'.*: -1.0"),
        ({"dynamic_friction": math.nan}, "'dynamic_friction'.*: nan"),
        ({"name": "two\nlines"}, "'name'.*printable"),
    ],
)
def test_the_error_for_a_value_out_of_range_names_option_and_value(
    changed: dict[str, Any], message: str
) -> None:
    with pytest.raises(ValueError, match=message):
        attrs.evolve(soft(1), **changed)


def test_codes_are_listed_in_ascending_order_with_their_names() -> None:
    assert describe_codes(materials_of(VoxSettings())) == "0 empty, 1 passive, 3 contractile"
    assert describe_codes({9: soft(9), 2: soft(2, name="gel")}) == "0 empty, 2 gel, 9"
    assert describe_codes({}) == "0 empty"


def test_the_solver_is_given_every_value() -> None:
    values = {"youngs_modulus": 2.0, "poisson_ratio": 0.1, "density": 3.0, "static_friction": 4.0}
    [(code, given)] = solver_palette({7: soft(7, **values, expansion_coefficient=5.0)}).items()
    assert code == 7
    assert attrs.asdict(given) == {**values, "expansion": 5.0, "dynamic_friction": 0.5}


class TestYoungsModulus:
    """The paper's engine stores it in single precision before it makes any bond."""

    moduli = st.floats(1e3, 1e9)
    bodies = (bar(1, 3, 3, 1), bar(3))  # one without bonds, whose time step follows from the modulus alone

    @given(modulus=moduli)
    @settings(max_examples=20)
    def test_is_simulated_in_single_precision(self, modulus: float) -> None:
        given, stored = (Vox(youngs_modulus=value) for value in (modulus, float(np.float32(modulus))))
        record = Record(("tip", "body"))
        for one, other in zip(*(vox.simulate(self.bodies, record) for vox in (given, stored)), strict=True):
            assert same_outcome(one, other)
        assert possible_clocks(given) == possible_clocks(stored)

    @pytest.mark.parametrize("modulus", [1234567.891, 7.3e6, 49999999.7])
    def test_that_single_precision_cannot_hold_survives_a_file(self, modulus: float, tmp_path: Path) -> None:
        vox, design = Vox(youngs_modulus=modulus), self.bodies[0]
        path = tmp_path / "odd.vxa"
        path.write_bytes(vox.export(design, "vxa").data)
        read = structure(Vox.settings_of(path), Vox, ("simulator",))
        assert {material.youngs_modulus for material in read.palette} >= {modulus}
        [(_, body)] = read.read(path)
        record = Record(("tip",))
        [given], [again] = vox.simulate([design], record), read.simulate([body], record)
        assert same_outcome(given, again)

    @pytest.mark.parametrize("bound", ["lower", "upper"])
    def test_at_a_limit_of_the_solver_is_accepted(self, bound: str) -> None:
        limit = getattr(libvox.PROPERTY_RANGES["youngs_modulus"], bound)
        [material] = solver_palette({1: soft(1, youngs_modulus=limit)}).values()
        assert material.youngs_modulus in libvox.PROPERTY_RANGES["youngs_modulus"]
        assert material.youngs_modulus == pytest.approx(limit, rel=1e-7)


@given(st.floats(allow_nan=False))
def test_single_precision_rounds_once(value: float) -> None:
    rounded = round_to_single(value)
    assert round_to_single(rounded) == rounded
    if abs(value) < 1e38:
        assert abs(rounded - value) <= np.spacing(np.float32(abs(rounded))) / 2


def test_numbers_beyond_single_precision_become_infinite() -> None:
    assert round_to_single(1e300) == np.inf
