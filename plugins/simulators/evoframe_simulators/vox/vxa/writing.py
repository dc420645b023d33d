"""Writing of VXA files with all sections, since the engine leaves members of missing ones uninitialized.

No text element is empty, because the engine's reader crashes on those (docs/physics.md, sections 12.8 and
12.9). Numbers have all their digits, so that reading a file returns what was written.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Mapping
from html import escape  # xml.sax.saxutils would import network modules
from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

from evoframe import CONTROLLER, MORPHOLOGY, InputError
from evoframe_simulators.vox.bodies import check_cycles
from evoframe_simulators.vox.materials import PaletteMaterial
from evoframe_simulators.vox.regions import FixedRegion
from evoframe_simulators.vox.settings import VoxSettings, materials_of, period_of
from evoframe_simulators.vox.vxa.cells import as_vox_holds
from evoframe_simulators.vox.vxa.file import FIRST_CHARACTER
from evoframe_simulators.vox.vxa.inert import CHANGES, CONTROLLERS, FEATURES, GROWTH, TASKS, UNUSED

__all__ = ["left_out", "write_vxa"]

_LARGEST_CODE = ord("~") - FIRST_CHARACTER
_PASSIVE, _EXPANDING, _CONTRACTING = (0.0, 0.6, 0.8), (0.8, 0.2, 0.0), (0.0, 0.6, 0.2)

# Options without a tag in the format: name, description, and whether the option affects only contacts.
_WITHOUT_TAG = (
    ("ramp", "the ramp at the start of the contraction", False),
    ("smallest_size", "the smallest size of voxels", False),
    ("largest_size", "the largest size of voxels", False),
    ("size_rule", "the rule for sizes beyond a limit", False),
    ("falling_code", "the material whose contact with the floor ends the motion", False),
    ("fluid_surface", "the surface on which the fluid acts", False),
    ("substeps", "the substeps of time steps", False),
    ("collision_envelope", "the distance at which contacts start", True),
    ("contact_damping", "the damping of contacts", True),
    ("contact_friction", "the friction of contacts", True),
    ("complete_contacts", "the complete search for contacts", True),
    ("step_limit", "the maximum number of steps", False),
    ("largest_strain", "the strain limit for divergence", False),
    ("largest_distance", "the distance limit for divergence", False),
)

_Node = str | Iterable[str]


def left_out(settings: VoxSettings) -> tuple[str, ...]:
    """Return the settings that a VXA file cannot express, unless they equal the engine's behavior."""
    defaults = attrs.fields_dict(VoxSettings)
    return tuple(
        f"{words} ({option} = {getattr(settings, option)})"
        for option, words, in_contacts in _WITHOUT_TAG
        if getattr(settings, option) != defaults[option].default
        and (settings.self_collision or not in_contacts)
    )


def write_vxa(
    settings: VoxSettings,
    material: NDArray[np.uint8],
    phase_cycles: NDArray[np.float64],
    acting: NDArray[np.bool_],
) -> bytes:
    """Return a body with its controller and settings as a VXA file: the same bytes for the same arguments.

    Args:
        settings: The settings.
        material: ``uint8[X, Y, Z]``; a code is the position of its material in the palette that is written.
        phase_cycles: Offsets, ``float64[X, Y, Z]``, cycles.
        acting: Mask of the cells whose offset has an effect, ``bool[X, Y, Z]``; others may have any value.

    Raises:
        InputError: The body is empty, or cannot be expressed in the format.
    """
    if not material.any():
        raise InputError("has no voxels; the engine requires at least one", key=MORPHOLOGY)
    check_cycles(phase_cycles[acting], CONTROLLER)
    usable = (material > 0) & np.isfinite(phase_cycles)
    lines = [
        *_node("Simulator", _simulator(settings)),
        *_node("Environment", _environment(settings, material.shape)),
        *_node("VXC", _vxc(settings, material, np.where(usable, phase_cycles, 0.0)), Version="0.93"),
    ]
    head = '<?xml version="1.0" encoding="ISO-8859-1"?>'
    text = "\n".join([head, *_node("VXA", lines, Version="1.0"), ""])
    return text.encode("ascii", errors="xmlcharrefreplace")  # equivalent for every reader


def _node(tag: str, content: _Node, **attributes: str) -> Iterator[str]:
    """Yield the lines of an element that contains a text, or other lines."""
    opening = " ".join([tag, *(f'{name}="{value}"' for name, value in attributes.items())])
    if isinstance(content, str):
        yield f"<{opening}>{content}</{tag}>"
        return
    yield f"<{opening}>"
    yield from (f"  {line}" for line in content)
    yield f"</{tag}>"


def _values(values: Mapping[str, float]) -> Iterator[str]:
    """Yield the lines of elements with numbers; flags are 0 and 1."""
    for tag, value in values.items():
        yield from _node(tag, repr(int(value) if isinstance(value, int) else float(value)))


def _section(tag: str, values: Mapping[str, float]) -> Iterator[str]:
    return _node(tag, _values(values))


def _simulator(settings: VoxSettings) -> Iterator[str]:
    yield from _section("Integration", {"Integrator": 0, "DtFrac": settings.time_step_fraction})
    damping = {
        "BondDampingZ": settings.bond_damping,
        "ColDampingZ": settings.collision_damping,
        "SlowDampingZ": settings.slow_damping,
    }
    yield from _section("Damping", damping)
    collisions = {
        "SelfColEnabled": settings.self_collision,
        "ColSystem": 3,
        "CollisionHorizon": settings.collision_horizon,
    }
    yield from _section("Collisions", collisions)
    yield from _section("Features", FEATURES)
    mesh = ["<DrawSmooth>1</DrawSmooth>", "<Vertices/>", "<Facets/>", "<Lines/>"]
    yield from _node("SurfMesh", _node("CMesh", mesh))
    stop = {
        "StopConditionType": 2,
        "StopConditionValue": settings.duration,
        "InitCmTime": settings.start_time,
        "ActuationStartTime": 0,
        "AfterlifeTime": 0,
        "MidLifeFreezeTime": 0,
    }
    yield from _section("StopCondition", stop)
    yield from _section("EquilibriumMode", {"EquilibriumModeEnabled": 0})
    result = ["<WriteFitnessFile>1</WriteFitnessFile>", "<FitnessFileName>fitness.xml</FitnessFileName>"]
    yield from _node("GA", [*result, *_values({"Fitness": 0, "FitnessType": 0, "TrackVoxel": 0})])
    yield from _values({"MinTempFact": 0.1, **CHANGES})


def _environment(settings: VoxSettings, canvas: tuple[int, ...]) -> Iterator[str]:
    x, y, z = canvas
    held = [as_vox_holds(region, (x, y, z)) for region in settings.fixed]
    regions = [_section("FRegion", _region(region)) for region in held if region is not None]
    count = _values({"NumBCs": len(regions)})
    yield from _node("Boundary_Conditions", itertools.chain(count, *regions))
    gravity = {
        "GravEnabled": settings.gravity != 0.0,
        "GravAcc": settings.gravity,
        "AlterGravityHalfway": 1,
        "FloorEnabled": settings.floor,
        "FloorSlope": settings.floor_slope,
    }
    yield from _section("Gravity", gravity)
    thermal = {
        "TempEnabled": 1,
        "TempAmp": settings.temperature_amplitude,
        "TempBase": settings.temperature_base,
        "VaryTempEnabled": 1,
        "TempPeriod": period_of(settings),
    }
    yield from _section("Thermal", thermal)
    for tag, values in CONTROLLERS.items():
        yield from _section(tag, values)
    traces = max(0.01, settings.duration / 100)  # keeps the engine's traces of long simulations small
    yield from _values({**GROWTH, "TimeBetweenTraces": traces, "SavePassiveData": 0, **TASKS})
    yield from _values(
        {"FluidEnvironment": settings.fluid_drag > 0.0, "AggregateDragCoefficient": settings.fluid_drag}
    )


def _region(region: FixedRegion) -> dict[str, float]:
    return {
        "PrimType": 0,
        **dict(zip("XYZ", region.origin, strict=True)),
        **{f"d{axis}": edge for axis, edge in zip("XYZ", region.size, strict=True)},
        "Radius": 0,
        "R": 0.4,
        "G": 0.6,
        "B": 0.4,
        "alpha": 1,
        "DofFixed": region.bits,
        **{f"{what}{axis}": 0 for what in ("Force", "Torque", "Displace", "AngDisplace") for axis in "XYZ"},
    }


def _vxc(settings: VoxSettings, material: NDArray[np.uint8], phase: NDArray[np.float64]) -> Iterator[str]:
    straight = {
        **{f"{axis}_Dim_Adj": 1 for axis in "XYZ"},
        **{f"{axis}_{what}_Offset": 0 for what in ("Line", "Layer") for axis in "XY"},
    }
    yield from _section("Lattice", {"Lattice_Dim": settings.voxel_size, **straight})
    squeeze = _values({f"{axis}_Squeeze": 1 for axis in "XYZ"})
    yield from _node("Voxel", ["<Vox_Name>BOX</Vox_Name>", *squeeze])
    yield from _node("Palette", _palette(materials_of(settings), int(material.max())))
    yield from _node("Structure", _structure(material, phase), Compression="ASCII_READABLE")


def _palette(materials: Mapping[int, PaletteMaterial], largest: int) -> Iterator[str]:
    """Yield the materials at the positions of their codes, up to the last one that the format can express."""
    if largest > _LARGEST_CODE:
        raise InputError(
            f"found material {largest}, expected at most {_LARGEST_CODE} in a VXA file", key=MORPHOLOGY
        )
    last = max(code for code in materials if code <= _LARGEST_CODE)
    for code in range(1, last + 1):
        yield from _node("Material", _material(materials.get(code, UNUSED), code), ID=str(code))


def _material(material: PaletteMaterial, code: int) -> Iterator[str]:
    expansion = material.expansion_coefficient
    colour = _PASSIVE if expansion == 0.0 else _EXPANDING if expansion > 0.0 else _CONTRACTING
    yield from _values({"MatType": 0})
    yield from _node("Name", escape(" ".join(material.name.split()), quote=False) or f"material {code}")
    yield from _section("Display", {**dict(zip(("Red", "Green", "Blue"), colour, strict=True)), "Alpha": 1})
    mechanical = {
        "MatModel": 0,
        "Elastic_Mod": material.youngs_modulus,
        "Plastic_Mod": 0,
        "Yield_Stress": 0,
        "FailModel": 0,
        "Fail_Stress": 0,
        "Fail_Strain": 0,
        "Density": material.density,
        "Poissons_Ratio": material.poisson_ratio,
        "CTE": expansion,
        "MaterialTempPhase": 0,
        "uStatic": material.static_friction,
        "uDynamic": material.dynamic_friction,
    }
    yield from _section("Mechanical", mechanical)


def _structure(material: NDArray[np.uint8], phase: NDArray[np.float64]) -> Iterator[str]:
    yield from _values({f"{axis}_Voxels": length for axis, length in zip("XYZ", material.shape, strict=True)})
    networks = ("RegenerationModel", "ForwardModel", "Controller")
    yield from _values({f"num{network}Synapses": 0 for network in networks})
    codes = ["".join(chr(FIRST_CHARACTER + code) for code in layer) for layer in _layers(material)]
    yield from _node("Data", map(_layer, codes))
    offsets = [",".join(map(repr, layer)) for layer in _layers(phase)]
    yield from _node("PhaseOffset", map(_layer, offsets))


def _layers(cells: NDArray[Any]) -> Iterator[list[Any]]:
    """Yield the cells of each z, x fastest."""
    for layer in np.moveaxis(cells, 2, 0):
        yield layer.T.ravel().tolist()


def _layer(text: str) -> str:
    if "]]>" in text:
        raise InputError("materials 45, 45, 14 in a row cannot be written to a VXA file", key=MORPHOLOGY)
    return f"<Layer><![CDATA[{text}]]></Layer>"
