"""Materials of voxels: the two built-in ones, or a custom palette."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import attrs
import numpy as np
from attrs import validators

import evoframe_libvox as libvox
from evoframe import EMPTY
from evoframe_simulators.vox.limits import LARGEST_CODE, VALID_PROPERTY, check_printable

__all__ = ["PaletteMaterial", "check_palette", "describe_codes", "round_to_single", "solver_palette"]


@attrs.frozen
class PaletteMaterial:
    """A material of a palette, in SI units (docs/physics.md, sections 1, 5 and 9).

    Attributes:
        code: Value of its cells in a body, 1 to 255; 0 is an empty cell.
        youngs_modulus: Young's modulus, Pa; simulated in single precision, as in the paper's engine.
        poisson_ratio: Poisson's ratio, 0 to 0.5; it affects only the twist of bonds.
        density: Density, kg/m3.
        expansion_coefficient: Linear thermal expansion, 1/degree; 0 is passive, and negative coefficients
            contract when positive ones expand.
        static_friction: Coefficient of static friction on the floor.
        dynamic_friction: Coefficient of dynamic friction.
        name: Name in messages, figures and exported files.
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
    """Reject a palette in which two materials have the same code; an attrs validator.

    Raises:
        ValueError: Two materials have the same code.
    """
    codes = [material.code for material in palette]
    for code in codes:
        if codes.count(code) > 1:
            raise ValueError(f"expected one material for each code, found {codes.count(code)} with {code}")


def describe_codes(materials: Mapping[int, PaletteMaterial]) -> str:
    """Return a list of the valid codes for messages: ``0 empty, 1 passive, 3 contractile``."""
    named = {code: f" {material.name}" if material.name else "" for code, material in materials.items()}
    return ", ".join(f"{code}{name}" for code, name in sorted({EMPTY: " empty", **named}.items()))


def solver_palette(materials: Mapping[int, PaletteMaterial]) -> dict[int, libvox.Material]:
    """Return the materials in the form that the solver takes, with moduli in single precision."""
    return {
        code: libvox.Material(
            youngs_modulus=_simulated_modulus(material),
            poisson_ratio=material.poisson_ratio,
            density=material.density,
            expansion=material.expansion_coefficient,
            static_friction=material.static_friction,
            dynamic_friction=material.dynamic_friction,
        )
        for code, material in materials.items()
    }


def _simulated_modulus(material: PaletteMaterial) -> float:
    """Return Young's modulus as the engine stores it; the lower limit, which would become less, remains."""
    smallest = libvox.PROPERTY_RANGES["youngs_modulus"].lower
    return max(smallest, round_to_single(material.youngs_modulus))


def round_to_single(value: float) -> float:
    """Round a number to single precision, as the engine does for some (docs/physics.md, section 1)."""
    with np.errstate(over="ignore"):  # becomes infinite, which the solver rejects
        return float(np.float32(value))
