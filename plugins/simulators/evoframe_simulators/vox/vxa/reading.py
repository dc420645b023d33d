"""Reading of VXA files: the body, its offsets, and the options of ``vox`` that reproduce the engine.

The engine is the fork ``reconfigurable_organisms``. Under water (``FluidEnvironment`` 1) it keeps gravity and
floor, and so does vox; evosoro's ``_voxcad_land_water`` disables both.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

from evoframe import InputError
from evoframe_simulators.files import naming_source
from evoframe_simulators.vox.materials import PaletteMaterial, round_to_single
from evoframe_simulators.vox.vxa.boxes import read_regions
from evoframe_simulators.vox.vxa.cells import Lattice
from evoframe_simulators.vox.vxa.checking import collect_unsupported
from evoframe_simulators.vox.vxa.document import parse_xml, shorten
from evoframe_simulators.vox.vxa.file import VxaFile
from evoframe_simulators.vox.vxa.sections import Section, Unsupported
from evoframe_simulators.vox.vxa.structure import read_canvas, read_material, read_phase

__all__ = ["read_vxa"]

_VERSIONS = ("", "0.93", "0.94")  # of the section VXC; other versions encode the structure differently
_HORIZON_SYSTEMS = (2, 3)  # equivalent in the engine
_PERIODS = 3  # of the temperature, even if it is constant
_DURATIONS = (2, _PERIODS)
_MOST_COUNTED_STEPS = 10**12


def read_vxa(path: Path) -> VxaFile:
    """Read a VXA file (docs/physics.md, sections 1, 4, 8, 9 and 12).

    Missing tags have the engine's defaults. One error reports all features that vox does not simulate (see
    :mod:`.vxa.schema`). These include a constant temperature, which this engine varies nevertheless and
    others do not, and a search for contacts in every step (``ColSystem`` 0 and 1), which finds contacts that
    the published one misses.

    Raises:
        InputError: The file cannot be read, is not a VXA file, or uses features that vox does not simulate.
    """
    with naming_source(path):
        element = parse_xml(path)
        if element.tag != "VXA":
            raise InputError(f"is not a VXA file: found root tag {shorten(str(element.tag))}, expected 'VXA'")
        root, unsupported = Section(element, ""), Unsupported()
        simulator, environment, vxc = (root.need(tag) for tag in ("Simulator", "Environment", "VXC"))
        structure, palette = vxc.need("Structure"), vxc.need("Palette")
        _check_encoding(vxc, structure, unsupported)
        lattice = Lattice(read_canvas(structure), vxc.need("Lattice").number("Lattice_Dim", 0.001, above=0.0))
        material = read_material(structure, lattice.canvas, palette.count("Material"))
        used = np.unique(material[material > 0]).tolist()
        collect_unsupported(root, used, unsupported)
        stop, steps = _stop(simulator, environment, unsupported)
        options = {
            "voxel_size": lattice.edge,
            "fixed": read_regions(environment, lattice, unsupported),
            **_integration(simulator),
            **_collisions(simulator, unsupported),
            **stop,
            **_surroundings(environment),
            **_thermal(environment, unsupported),
        }
        unsupported.check()
        numbered = enumerate(palette.all("Material"), 1)
        options["palette"] = tuple(_material(found, code) for code, found in numbered if code in used)
        return VxaFile(options, material, read_phase(structure, lattice.canvas), steps)


def _check_encoding(vxc: Section, structure: Section, unsupported: Unsupported) -> None:
    """Reject a structure in an unknown encoding before it is decoded."""
    compression = str(structure.element.get("Compression", ""))
    if compression != "ASCII_READABLE":
        unsupported.add(f"{structure.place} Compression", shorten(compression), "expected ASCII_READABLE")
    version = str(vxc.element.get("Version", ""))
    if version not in _VERSIONS:
        unsupported.add(f"{vxc.place} Version", shorten(version), "expected 0.93 or 0.94")
    unsupported.check()


def _integration(simulator: Section) -> dict[str, Any]:
    integration, damping = simulator.find("Integration"), simulator.need("Damping")
    return {
        "time_step_fraction": integration.number("DtFrac", 0.9, above=0.0) if integration else 0.9,
        "bond_damping": damping.number("BondDampingZ", 0.1, least=0.0),
        "collision_damping": damping.number("ColDampingZ", 1.0, least=0.0),
        "slow_damping": damping.number("SlowDampingZ", 1.0, least=0.0),
    }


def _collisions(simulator: Section, unsupported: Unsupported) -> dict[str, Any]:
    section = simulator.find("Collisions")
    if section is None or not section.flag("SelfColEnabled"):
        return {"self_collision": False}
    system = section.whole("ColSystem", 3, most=3)
    if system not in _HORIZON_SYSTEMS:
        unsupported.add(section.at("ColSystem"), shorten(str(system)), "expected 3")
    return {"self_collision": True, "collision_horizon": section.number("CollisionHorizon", 2.0, least=1.0)}


def _stop(
    simulator: Section, environment: Section, unsupported: Unsupported
) -> tuple[dict[str, Any], int | None]:
    """Return start and duration as options, and the number of steps if the file sets that instead."""
    section = simulator.need("StopCondition")
    start = section.number("InitCmTime", 0.0, least=0.0)
    if section.number("ActuationStartTime", 0.0, least=0.0) > start:
        late = section.text("ActuationStartTime") or ""
        unsupported.add(section.at("ActuationStartTime"), shorten(late), "later than InitCmTime")
    kind = section.whole("StopConditionType", 0, most=6)
    if kind == 1:  # the engine rounds the number and makes one step more
        counted = section.number("StopConditionValue", 0.0, least=0.0)
        if counted > _MOST_COUNTED_STEPS:
            raise InputError(
                f"found {counted:g} steps, expected at most {_MOST_COUNTED_STEPS:g}",
                key=section.at("StopConditionValue"),
            )
        return {"start_time": start}, math.floor(counted + 0.5) + 1
    if kind not in _DURATIONS:
        why = "expected a number of steps (1), a time (2) or temperature periods (3)"
        unsupported.add(section.at("StopConditionType"), shorten(str(kind)), why)
        return {}, None
    duration = section.number("StopConditionValue", 0.0, above=0.0)
    if kind == _PERIODS:
        duration *= round_to_single(environment.need("Thermal").number("TempPeriod", 0.1, above=0.0))
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


def _thermal(environment: Section, unsupported: Unsupported) -> dict[str, Any]:
    """Return the temperature options; without actuation the amplitude equals the base."""
    section = environment.need("Thermal")
    base = section.number("TempBase", 25.0)
    if section.text("TempAmplitude") is None:
        highest = section.number("TempAmp", base)
    else:
        swing = section.number("TempAmplitude", 0.0)
        # The engine holds the swing in single precision. If adding the base would round it, drop the base.
        base = base if round_to_single(base + swing - base) == round_to_single(swing) else 0.0
        highest = base + swing
    if not section.flag("TempEnabled") or highest == base:
        return {"temperature_base": base, "temperature_amplitude": base}
    if not section.flag("VaryTempEnabled"):
        unsupported.add(section.at("VaryTempEnabled"), "'0'", "constant temperature with TempEnabled = 1")
    period = section.number("TempPeriod", 0.1, above=0.0)
    return {"temperature_base": base, "temperature_amplitude": highest, "frequency": 1.0 / period}


def _material(found: Section, code: int) -> PaletteMaterial:
    """Return a material of the palette, with its position as code."""
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
        raise InputError(str(error), key=mechanical.place) from error
