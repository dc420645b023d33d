"""What voxels are made of: the two built-in materials, or a palette of one's own."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import attrs
import numpy as np
from attrs import validators

import evoframe_libvox as libvox
from evoframe import CONTRACTILE, EMPTY, PASSIVE

if TYPE_CHECKING:
    from evoframe_simulators.vox.simulator import Vox

__all__ = ["PaletteMaterial", "check_palette", "described", "materials_of", "single", "solver_palette"]

_LARGEST_CODE = 255
_POSITIVE = validators.gt(0.0)
_NOT_NEGATIVE = validators.ge(0.0)

# Options of vox that describe its two built-in materials, and so say nothing of a palette.
_BUILT_IN = (
    *("youngs_modulus", "poisson_ratio", "density", "expansion_coefficient"),
    *("static_friction", "dynamic_friction"),
)


def _check_name(_: Any, attribute: attrs.Attribute[str], value: str) -> None:
    if not value.isprintable():
        raise ValueError(f"'{attribute.name}' must be one line of printable characters: {value!r}")


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

    code: int = attrs.field(validator=[validators.ge(1), validators.le(_LARGEST_CODE)])
    youngs_modulus: float = attrs.field(validator=_POSITIVE)
    poisson_ratio: float = attrs.field(validator=[validators.ge(0.0), validators.lt(0.5)])
    density: float = attrs.field(validator=_POSITIVE)
    expansion_coefficient: float
    static_friction: float = attrs.field(default=1.0, validator=_NOT_NEGATIVE)
    dynamic_friction: float = attrs.field(default=0.5, validator=_NOT_NEGATIVE)
    name: str = attrs.field(default="", validator=_check_name)


def check_palette(_: Any, __: Any, palette: Sequence[PaletteMaterial]) -> None:
    """Refuse a palette with one code for two materials; an attrs validator.

    Raises:
        ValueError: Says which code.
    """
    codes = [material.code for material in palette]
    for code in codes:
        if codes.count(code) > 1:
            raise ValueError(f"expected one material for each code, found {codes.count(code)} for {code}")


def materials_of(vox: Vox) -> dict[int, PaletteMaterial]:
    """Return the material of each code that a body may have."""
    if vox.palette:
        return {material.code: material for material in vox.palette}
    options = {name: getattr(vox, name) for name in _BUILT_IN}
    passive = {**options, "expansion_coefficient": 0.0}
    return {
        PASSIVE: PaletteMaterial(code=PASSIVE, name="passive", **passive),
        CONTRACTILE: PaletteMaterial(code=CONTRACTILE, name="contractile", **options),
    }


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
