"""What voxels are made of: the two built-in materials, or a palette of one's own."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import attrs
import numpy as np
from attrs import validators

import evoframe_libvox as libvox
from evoframe import EMPTY
from evoframe_simulators.vox.limits import LARGEST_CODE, VALID_PROPERTY, check_printable

__all__ = ["PaletteMaterial", "check_palette", "described", "single", "solver_palette"]


@attrs.frozen
class PaletteMaterial:
    """One material of a palette; SI units (physics.md, sections 1, 5 and 9).

    Attributes:
        code: What stands for it in a body, 1 to 255; 0 is an empty cell.
        youngs_modulus: Pa.
        poisson_ratio: At least 0, below 0.5; it acts on the twist of bonds only.
        density: kg/m3.
        expansion_coefficient: Linear thermal expansion, 1/degree; 0 is passive, and a negative one contracts
            when the others expand.
        static_friction: Share of the floor's push up to which a resting voxel sticks.
        dynamic_friction: Share of the push that brakes a sliding voxel.
        name: For people.
    """

    code: int = attrs.field(validator=[validators.ge(1), validators.le(LARGEST_CODE)])
    youngs_modulus: float = attrs.field(validator=VALID_PROPERTY["youngs_modulus"])
    poisson_ratio: float = attrs.field(validator=VALID_PROPERTY["poisson_ratio"])
    density: float = attrs.field(validator=VALID_PROPERTY["density"])
    expansion_coefficient: float = attrs.field(validator=VALID_PROPERTY["expansion"])
    static_friction: float = attrs.field(default=1.0, validator=VALID_PROPERTY["static_friction"])
    dynamic_friction: float = attrs.field(default=0.5, validator=VALID_PROPERTY["dynamic_friction"])
    name: str = attrs.field(default="", validator=check_printable)


def check_palette(_: Any, __: Any, palette: Sequence[PaletteMaterial]) -> None:
    """Refuse a palette with one code for two materials; an attrs validator.

    Raises:
        ValueError: Says which code.
    """
    codes = [material.code for material in palette]
    for code in codes:
        if codes.count(code) > 1:
            raise ValueError(f"expected one material for each code, found {codes.count(code)} for {code}")


def described(materials: Mapping[int, PaletteMaterial]) -> str:
    """Return the codes that a body may have, in words: ``0 empty, 1 passive, 3 contractile``."""
    named = {code: f" {material.name}" if material.name else "" for code, material in materials.items()}
    return ", ".join(f"{code}{name}" for code, name in sorted({EMPTY: " empty", **named}.items()))


def solver_palette(materials: Mapping[int, PaletteMaterial]) -> dict[int, libvox.Material]:
    """Return the materials as the solver wants them."""
    return {
        code: libvox.Material(
            youngs_modulus=material.youngs_modulus,
            poisson_ratio=material.poisson_ratio,
            density=material.density,
            expansion=material.expansion_coefficient,
            static_friction=material.static_friction,
            dynamic_friction=material.dynamic_friction,
        )
        for code, material in materials.items()
    }


def single(value: float) -> float:
    """Return a number as single precision holds it: the engine reads some so (physics.md, section 1)."""
    with np.errstate(over="ignore"):  # infinite then, and refused by the solver
        return float(np.float32(value))
