"""Simulators offered by the plugin, and their optional capabilities."""

from __future__ import annotations

import pytest

from evoframe import (
    SupportsBitGeneration,
    SupportsDialects,
    SupportsDuration,
    SupportsExport,
    SupportsGeometry,
    SupportsObjective,
    SupportsProvenance,
    SupportsPublished,
    SupportsRandomControllers,
    SupportsReading,
    SupportsSettings,
    SupportsVariants,
    SupportsWholeDesigns,
)
from evoframe_simulators import Functions, Vox, evoframe_simulators


def test_they_are_offered_by_name() -> None:
    assert evoframe_simulators() == {"functions": Functions, "vox": Vox}


@pytest.mark.parametrize(
    "capability",
    [
        SupportsBitGeneration,
        SupportsDialects,
        SupportsDuration,
        SupportsExport,
        SupportsGeometry,
        SupportsObjective,
        SupportsProvenance,
        SupportsPublished,
        SupportsRandomControllers,
        SupportsReading,
        SupportsSettings,
        SupportsVariants,
        SupportsWholeDesigns,
    ],
)
def test_vox_has_every_capability_of_a_simulator(capability: type) -> None:
    assert isinstance(Vox(), capability)
