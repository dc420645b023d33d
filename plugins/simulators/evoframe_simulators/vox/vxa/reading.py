"""VXA files read: the body, its offsets, and the options of ``vox`` that simulate it as the engine would.

The engine is that of the fork ``reconfigurable_organisms``. Under water (``FluidEnvironment`` 1) it keeps
gravity and floor, and so does vox; evosoro's ``_voxcad_land_water`` switches both off then.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

from evoframe import InputError
from evoframe_simulators.files import naming
from evoframe_simulators.vox.materials import PaletteMaterial, single
from evoframe_simulators.vox.vxa.boxes import regions_in
from evoframe_simulators.vox.vxa.cells import Lattice
from evoframe_simulators.vox.vxa.checking import refuse_the_unknown
from evoframe_simulators.vox.vxa.document import parsed, shown
from evoframe_simulators.vox.vxa.file import VxaFile
from evoframe_simulators.vox.vxa.sections import Refusals, Section
from evoframe_simulators.vox.vxa.structure import canvas_in, material_in, phase_in

__all__ = ["read_vxa"]

_VERSIONS = ("", "0.93", "0.94")  # of the section VXC; the structure of others is written in another way
_HORIZON_SYSTEMS = (2, 3)  # one and the same in the engine, whose choice of all voxels is never taken
_PERIODS = 3  # of the temperature, whether it varies or not
_DURATIONS = (2, _PERIODS)
_MOST_COUNTED_STEPS = 10**12


def read_vxa(path: Path) -> VxaFile:
    """Return what a VXA file says (physics.md, sections 1, 4, 8, 9 and 12).

    Missing tags have the engine's values; what vox does not simulate is refused by name, all of it at once
    (see :mod:`.vxa.schema`). Refused are also a temperature that does not vary, which this
    engine lets vary all the same and others do not, and a search for contacts in every step (``ColSystem`` 0
    and 1), which finds some that the published one misses.

    Raises:
        InputError: The file cannot be read, is no VXA file, or asks for more; says what, and where.
    """
    with naming(path):
        element = parsed(path)
        if element.tag != "VXA":
            raise InputError(f"is no VXA file: it begins with {shown(str(element.tag))}; expected 'VXA'")
        root, refusals = Section(element, ""), Refusals()
        simulator, environment, vxc = (root.need(tag) for tag in ("Simulator", "Environment", "VXC"))
        structure, palette = vxc.need("Structure"), vxc.need("Palette")
        _check_encoding(vxc, structure, refusals)
        lattice = Lattice(canvas_in(structure), vxc.need("Lattice").number("Lattice_Dim", 0.001, above=0.0))
        material = material_in(structure, lattice.canvas, palette.count("Material"))
        used = np.unique(material[material > 0]).tolist()
        refuse_the_unknown(root, used, refusals)
        stop, steps = _stop(simulator, environment, refusals)
        options = {
            "voxel_size": lattice.edge,
            "fixed": regions_in(environment, lattice, refusals),
            **_integration(simulator),
            **_collisions(simulator, refusals),
            **stop,
            **_surroundings(environment),
            **_thermal(environment, refusals),
        }
        refusals.check()
        numbered = enumerate(palette.all("Material"), 1)
        options["palette"] = tuple(_material(found, code) for code, found in numbered if code in used)
        return VxaFile(options, material, phase_in(structure, lattice.canvas), steps)


def _check_encoding(vxc: Section, structure: Section, refusals: Refusals) -> None:
    """Refuse a structure that is not written in characters, before it is read as if it were."""
    compression = str(structure.element.get("Compression", ""))
    if compression != "ASCII_READABLE":
        refusals.add(f"{structure.place} Compression", shown(compression), "vox reads ASCII_READABLE")
    version = str(vxc.element.get("Version", ""))
    if version not in _VERSIONS:
        refusals.add(f"{vxc.place} Version", shown(version), "vox reads 0.93 and 0.94")
    refusals.check()


def _integration(simulator: Section) -> dict[str, Any]:
    integration, damping = simulator.find("Integration"), simulator.need("Damping")
    return {
        "time_step_fraction": integration.number("DtFrac", 0.9, above=0.0) if integration else 0.9,
        "bond_damping": damping.number("BondDampingZ", 0.1, least=0.0),
        "collision_damping": damping.number("ColDampingZ", 1.0, least=0.0),
        "slow_damping": damping.number("SlowDampingZ", 1.0, least=0.0),
    }


def _collisions(simulator: Section, refusals: Refusals) -> dict[str, Any]:
    section = simulator.find("Collisions")
    if section is None or not section.flag("SelfColEnabled"):
        return {"self_collision": False}
    system = section.whole("ColSystem", 3, most=3)
    if system not in _HORIZON_SYSTEMS:
        refusals.add(section.at("ColSystem"), shown(str(system)), "vox searches as 3 does")
    return {"self_collision": True, "collision_horizon": section.number("CollisionHorizon", 2.0, least=1.0)}


def _stop(simulator: Section, environment: Section, refusals: Refusals) -> tuple[dict[str, Any], int | None]:
    """Return when the actuation begins and the simulation ends, and the steps if they are counted instead."""
    section = simulator.need("StopCondition")
    start = section.number("InitCmTime", 0.0, least=0.0)
    if section.number("ActuationStartTime", 0.0, least=0.0) > start:
        late = section.text("ActuationStartTime") or ""
        refusals.add(section.at("ActuationStartTime"), shown(late), "later than InitCmTime")
    kind = section.whole("StopConditionType", 0, most=6)
    if kind == 1:  # which the engine rounds, and exceeds by one step
        counted = section.number("StopConditionValue", 0.0, least=0.0)
        if counted > _MOST_COUNTED_STEPS:
            raise InputError(
                f"{section.at('StopConditionValue')}: {counted:g} steps; at most {_MOST_COUNTED_STEPS:g}"
            )
        return {"start_time": start}, math.floor(counted + 0.5) + 1
    if kind not in _DURATIONS:
        why = "vox stops after a time (2), periods of the temperature (3) or a number of steps (1)"
        refusals.add(section.at("StopConditionType"), shown(str(kind)), why)
        return {}, None
    duration = section.number("StopConditionValue", 0.0, above=0.0)
    if kind == _PERIODS:
        duration *= single(environment.need("Thermal").number("TempPeriod", 0.1, above=0.0))
    return {"start_time": start, "duration": duration}, None


def _surroundings(environment: Section) -> dict[str, Any]:
    gravity = environment.need("Gravity")
    floor = gravity.flag("FloorEnabled")
    options = {
        "gravity": gravity.number("GravAcc", -9.81) if gravity.flag("GravEnabled") else 0.0,
        "floor": floor,
        "floor_slope": gravity.number("FloorSlope", 0.0) if floor else 0.0,
    }
    if environment.flag("FluidEnvironment"):
        options["fluid_drag"] = environment.number("AggregateDragCoefficient", 0.0, least=0.0)
    return options


def _thermal(environment: Section, refusals: Refusals) -> dict[str, Any]:
    """Return the temperatures; without an actuation the amplitude is the base."""
    section = environment.need("Thermal")
    base = section.number("TempBase", 25.0)
    if section.text("TempAmplitude") is None:
        highest = section.number("TempAmp", base)
    else:
        swing = section.number("TempAmplitude", 0.0)
        # The engine holds the swing in single precision; where a sum would lose it, the base is not needed.
        base = base if single(base + swing - base) == single(swing) else 0.0
        highest = base + swing
    if not section.flag("TempEnabled") or highest == base:
        return {"temperature_base": base, "temperature_amplitude": base}
    if not section.flag("VaryTempEnabled"):
        refusals.add(section.at("VaryTempEnabled"), "'0'", "with TempEnabled = 1, a constant temperature")
    period = section.number("TempPeriod", 0.1, above=0.0)
    return {"temperature_base": base, "temperature_amplitude": highest, "frequency": 1.0 / period}


def _material(found: Section, code: int) -> PaletteMaterial:
    """Return a material of the palette; its code is its position."""
    mechanical = found.need("Mechanical")
    name = " ".join((found.text("Name") or "").split())
    try:
        return PaletteMaterial(
            code=code,
            youngs_modulus=mechanical.number("Elastic_Mod", 0.0, above=0.0),
            poisson_ratio=mechanical.number("Poissons_Ratio", 0.0, least=0.0),
            density=mechanical.number("Density", 0.0, above=0.0),
            expansion_coefficient=mechanical.number("CTE", 0.0),
            static_friction=mechanical.number("uStatic", 0.0, least=0.0),
            dynamic_friction=mechanical.number("uDynamic", 0.0, least=0.0),
            name=name if name.isprintable() else "",
        )
    except ValueError as error:
        raise InputError(f"{mechanical.place}: {error}") from error
