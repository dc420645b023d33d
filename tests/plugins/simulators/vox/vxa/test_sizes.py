"""Limits of sizes by the rules of each engine."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from lxml import etree

from evoframe import Design, InputError, Record
from evoframe_simulators import PaletteMaterial, Vox
from evoframe_simulators.vox.vxa.dialects import Engine
from evoframe_simulators.vox.vxa.faults import Faults
from evoframe_simulators.vox.vxa.sections import Section
from evoframe_simulators.vox.vxa.sizes import read_sizes

BOTH = (0.0, 0.14, -0.14)


def sizes(
    engine: Engine, environment: str = "", simulator: str = "", strains: tuple[float, ...] = BOTH
) -> tuple[tuple[Any, ...], Faults]:
    faults = Faults()
    one, other = (
        Section(etree.fromstring(f"<{name}>{text}</{name}>"), name)
        for name, text in (("Simulator", simulator), ("Environment", environment))
    )
    options = read_sizes(one, other, strains, engine, faults)
    return (options["smallest_size"], options["largest_size"], options["size_rule"]), faults


@pytest.mark.parametrize(
    ("engine", "environment", "simulator", "expected"),
    [
        (Engine.FORK, "", "", (0.1, 3.0, "hold")),
        (Engine.FORK, "", "<MinTempFact>0.9</MinTempFact>", (0.9, 3.0, "hold")),
        (Engine.FORK, "<ContractOnly>1</ContractOnly>", "", (0.1, 1.0, "hold")),
        (Engine.FORK, "<ExpandOnly>1</ExpandOnly>", "<MinTempFact>0.9</MinTempFact>", (1.0, 3.0, "hold")),
        (Engine.FORK, "<GrowthAmplitude>0.5</GrowthAmplitude>", "", (0.1, 3.0, "hold")),
        (Engine.EVOSORO_LAND, "", "", (0.1, 1.0, "hold")),
        (Engine.EVOSORO_LAND, "<GrowthAmplitude>0.5</GrowthAmplitude>", "", (0.1, 1.5, "hold")),
        (Engine.EVOSORO_LAND, "<GrowthAmplitude>99</GrowthAmplitude>", "", (0.1, 10.0, "hold")),
        (Engine.EVOSORO_LAND, "<ContractOnly>1</ContractOnly>", "", (0.1, 1.0, "hold")),
        (Engine.EVOSORO_WATER, "", "<MinTempFact>0.9</MinTempFact>", (0.1, 10.0, "clamp")),
        (Engine.VOXCRAFT, "", "<EnableExpansion>1</EnableExpansion>", (0.1, 10.0, "clamp")),
    ],
)
def test_limits(engine: Engine, environment: str, simulator: str, expected: tuple[Any, ...]) -> None:
    found, faults = sizes(engine, environment, simulator)
    assert found == expected
    faults.check()


@pytest.mark.parametrize(
    ("strains", "expected"),
    [((0.0, 0.1), (0.1, 1.0)), ((-0.1,), (1.0, 10.0)), ((0.0,), (1.0, 10.0))],
)
def test_voxcraft_only_lowers_the_temperature(
    strains: tuple[float, ...], expected: tuple[float, float]
) -> None:
    found, faults = sizes(Engine.VOXCRAFT, strains=strains)
    assert found == (*expected, "clamp")
    faults.check()


@pytest.mark.parametrize(
    ("engine", "environment", "strains", "key"),
    [
        (Engine.VOXCRAFT, "", BOTH, "Simulator/EnableExpansion"),
        (Engine.EVOSORO_WATER, "", (9.5,), "Environment/Thermal"),
        (Engine.EVOSORO_LAND, "<StickyFloor>1</StickyFloor>", BOTH, "Environment/StickyFloor"),
        (
            Engine.EVOSORO_LAND,
            "<FallingProhibited>1</FallingProhibited>",
            BOTH,
            "Environment/FallingProhibited",
        ),
    ],
)
def test_rules_that_vox_lacks_are_faults(
    engine: Engine, environment: str, strains: tuple[float, ...], key: str
) -> None:
    _, faults = sizes(engine, environment, strains=strains)
    with pytest.raises(InputError) as caught:
        faults.check()
    assert caught.value.key == key


@pytest.mark.parametrize(("expansion", "bounds"), [(0.01, (0.85, 1.0)), (-0.01, (1.0, 1.15))])
def test_a_voxel_of_voxcraft_keeps_to_one_side_of_its_edge(
    expansion: float, bounds: tuple[float, float]
) -> None:
    (smallest, largest, rule), _ = sizes(Engine.VOXCRAFT, strains=(expansion * 14.0,))
    vox = Vox(
        palette=(PaletteMaterial(1, 5e6, 0.35, 1e6, expansion),),
        duration=0.5,
        fixed=(),
        smallest_size=smallest,
        largest_size=largest,
        size_rule=rule,
        temperature_amplitude=39.0,
    )
    design = Design({"morphology": np.ones((2, 1, 1), np.uint8), "controller": np.zeros((2, 1, 1))})
    [outcome] = vox.simulate([design], Record(("voxels",)))
    distance = np.diff(outcome.tracks["voxels"][:, :, 0, 0, 0], axis=1) / vox.voxel_size
    assert bounds[0] - 0.05 < distance.min() < distance.max() < bounds[1] + 0.05
    assert np.ptp(distance) > 0.1
