"""Contents of a VXA file, and its settings."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from types import MappingProxyType
from typing import Any, Final

import attrs
import numpy as np
from numpy.typing import NDArray

from evoframe import InputError
from evoframe_simulators.vox.materials import PaletteMaterial
from evoframe_simulators.vox.models import possible_clocks, strip_body_index, time_step_of
from evoframe_simulators.vox.regions import FixedRegion
from evoframe_simulators.vox.settings import VoxSettings
from evoframe_simulators.vox.vxa.dialects import Engine, Reading
from evoframe_simulators.vox.vxa.faults import Faults

__all__ = ["FIRST_CHARACTER", "SHAPES", "VxaFile"]

FIRST_CHARACTER = 48
"""Code point of ``0``; the character of a material in a layer is this plus its position in the palette."""

SHAPES = ("a box", "a cylinder", "a sphere", "a mesh")
"""Shapes by a region's ``PrimType``."""

_STOP = "Simulator/StopCondition"

_PLACES: Final[Mapping[str, str]] = {
    "voxel_size": "VXC/Lattice/Lattice_Dim",
    "time_step_fraction": "Simulator/Integration/DtFrac",
    "bond_damping": "Simulator/Damping/BondDampingZ",
    "collision_damping": "Simulator/Damping/ColDampingZ",
    "slow_damping": "Simulator/Damping/SlowDampingZ",
    "collision_horizon": "Simulator/Collisions/CollisionHorizon",
    "duration": f"{_STOP}/StopConditionValue",
    "start_time": f"{_STOP}/InitCmTime",
    "smallest_size": "Simulator/MinTempFact",
    "largest_size": "Environment/GrowthAmplitude",
    "gravity": "Environment/Gravity/GravAcc",
    "floor_slope": "Environment/Gravity/FloorSlope",
    "fluid_drag": "Environment/AggregateDragCoefficient",
    "temperature_base": "Environment/Thermal/TempBase",
    "temperature_amplitude": "Environment/Thermal/TempAmp",
    "frequency": "Environment/Thermal/TempPeriod",
    "period": "Environment/Thermal/TempPeriod",
    "floor_damping": "Simulator/Damping/ColDampingZ",
}
"""Option of ``vox``, or setting of the solver -> path of the tag that sets it."""

_TAGS: Final[Mapping[str, str]] = {
    "youngs_modulus": "Elastic_Mod",
    "poisson_ratio": "Poissons_Ratio",
    "density": "Density",
    "expansion_coefficient": "CTE",
    "static_friction": "uStatic",
    "dynamic_friction": "uDynamic",
}
"""Option of a material -> its tag."""

_FORK: Final = Reading("fork", Engine.FORK)
_NOTHING: Final[Mapping[str, Any]] = MappingProxyType({})
_OPTION = re.compile(r"\b(" + "|".join(_PLACES) + r")\b")


@attrs.frozen(eq=False)
class VxaFile:
    """A body with its controller, and the options of ``vox`` for its simulation.

    Attributes:
        options: Name -> value, as arguments of ``VoxSettings``, except the palette.
        materials: The materials of the body, as arguments of ``PaletteMaterial``.
        material: Positions in the palette, ``uint8[X, Y, Z]``; 0 is empty.
        phase: Unconverted offsets, ``float64[X, Y, Z]``; the engine interprets them as cycles.
        steps: Number of steps, if the file sets it instead of a duration.
        complete: Whether the file has settings of a simulation, which a VXC file lacks.
        rules: The rules by which it was read.
        notes: What a user should know about the reading, a line each.
    """

    options: Mapping[str, Any]
    materials: tuple[Mapping[str, Any], ...]
    material: NDArray[np.uint8]
    phase: NDArray[np.float64]
    steps: int | None = None
    complete: bool = True
    rules: Reading = _FORK
    notes: tuple[str, ...] = ()

    @property
    def canvas(self) -> tuple[int, int, int]:
        """Number of cells along x, y and z."""
        x, y, z = self.material.shape
        return x, y, z

    def toml(self, given: Mapping[str, Any] = _NOTHING) -> dict[str, Any]:
        """Return the options that the file sets, as TOML values: all of them, so that no preset adds any.

        A VXC file sets only those of its body. The duration is missing if *given* has it.

        Args:
            given: Options that override those of the file, as TOML values; tags that they replace are not
                checked. They are in the result, unless they are invalid.

        Raises:
            InputError: A value is out of range, a tag is missing, or the solver rejects the combination; in
                the words of the file.
        """
        self._check_values(given)
        if not self.complete:
            return {
                "voxel_size": self.options["voxel_size"],
                "palette": [dict(each) for each in self.materials],
            }
        try:
            settings = VoxSettings(**self._merged(given))
        except (AttributeError, TypeError, ValueError):  # the core reports invalid overrides
            return {**dict(given), "palette": [dict(each) for each in self.materials]}
        return attrs.asdict(self._checked(settings, given), value_serializer=_as_toml)

    def settings(self) -> VoxSettings:
        """Return the settings for the body; settings that are not in the file have their defaults.

        Raises:
            InputError: As for :meth:`toml`.
        """
        self._check_values(())
        return self._checked(VoxSettings(**self._merged(_NOTHING)), _NOTHING)

    def _merged(self, given: Mapping[str, Any]) -> dict[str, Any]:
        """Return arguments of ``VoxSettings``.

        Raises:
            TypeError: An override has an unexpected type or key.
            ValueError: An override is out of range.
        """
        merged = {"palette": self.materials, **self.options, **given}
        if "fixed" in given:
            merged["fixed"] = tuple(
                FixedRegion(**{name: tuple(value) for name, value in region.items()})
                for region in given["fixed"]
            )
        return {**merged, "palette": tuple(PaletteMaterial(**each) for each in merged["palette"])}

    def collect_faults(self, given: Collection[str], faults: Faults) -> None:
        """Add the values of the file that are out of range, and the end that it lacks.

        Args:
            given: Names of the options that override those of the file.
            faults: Faults of the file.
        """
        for field in attrs.fields(VoxSettings):
            if field.name in self.options and field.name not in given:
                _check(field, self.options[field.name], _PLACES.get(field.name, field.name), faults)
        if "palette" not in given:
            for material in self.materials:
                for field in attrs.fields(PaletteMaterial):
                    place = (
                        f"VXC/Palette/Material {material['code']}/Mechanical/{_TAGS.get(field.name, 'Name')}"
                    )
                    _check(field, material[field.name], place, faults)
        endless = self.steps is None and "duration" not in {*self.options, *given}
        if self.complete and endless and not faults.within(_STOP):
            faults.missing(
                _STOP, "the file does not say when its simulation ends; set --set simulator.duration=SECONDS"
            )

    def _check_values(self, given: Collection[str]) -> None:
        """Report the faults of the file."""
        faults = Faults()
        self.collect_faults(given, faults)
        faults.check()

    def _checked(self, settings: VoxSettings, given: Mapping[str, Any]) -> VoxSettings:
        """Return settings with the duration of a number of steps, checked by the solver."""
        try:
            if self.steps is not None and "duration" not in given:
                duration = (self.steps - 0.5) * time_step_of(settings, self.material)
                settings = attrs.evolve(settings, duration=duration)
            possible_clocks(settings)
        except ValueError as error:
            words = strip_body_index(error)
            raise InputError(_OPTION.sub(lambda found: _named(found[0], given), words)) from error
        return settings


def _check(field: attrs.Attribute[Any], value: Any, place: str, faults: Faults) -> None:
    """Add a fault if the validator of an option rejects a value."""
    if field.validator is None:
        return
    try:
        field.validator(None, field, value)
    except ValueError as error:
        faults.out_of_range(place, str(error).removeprefix(f"'{field.name}' "))


def _named(option: str, given: Mapping[str, Any]) -> str:
    """Return the tag of an option, unless the user has set the option."""
    return option if option in given else _PLACES[option].rpartition("/")[2]


def _as_toml(_: Any, __: Any, value: Any) -> Any:
    """Return lists for tuples, which TOML does not have."""
    return list(value) if isinstance(value, tuple) else value
