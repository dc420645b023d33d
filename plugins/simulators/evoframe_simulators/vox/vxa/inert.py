"""Sections of a VXA file that must be present although all their features are off."""

from __future__ import annotations

from collections.abc import Mapping

from evoframe_simulators.vox.materials import PaletteMaterial

__all__ = ["CHANGES", "CONTROLLERS", "FEATURES", "GROWTH", "TASKS", "UNUSED"]

Values = Mapping[str, float]

FEATURES: Values = {
    "MaxVelLimitEnabled": 0,
    "MaxVoxVelLimit": 0.1,
    "BlendingEnabled": 0,
    "XMixRadius": 0,
    "YMixRadius": 0,
    "ZMixRadius": 0,
    "BlendModel": 0,
    "PolyExp": 1,
    "FluidDampEnabled": 0,
    "PoissonKickBackEnabled": 0,
    "VolumeEffectsEnabled": 0,
    "EnforceLatticeEnabled": 0,
}

CHANGES: Values = {
    "MaxTempFactChange": 0,
    "DampEvolvedStiffness": 0,
    "MaxStiffnessChange": 0,
    "MinElasticMod": 0,
    "MaxElasticMod": 0,
}
"""Values for variable stiffness, which is off unless the structure has a section for it."""

CONTROLLERS: Mapping[str, Values] = {
    "NeuralNet": {
        "NeuralNetUpdatesPerTempCycle": 0,
        "TouchSensorsEnabled": 0,
        "ProprioceptionSensorsEnabled": 0,
        "PacemakerSensorsEnabled": 0,
        "NumHiddenNeuronsPerLayer": 0,
        "NumHiddenLayers": 0,
        "OutputSmoothing": 0,
    },
    "LightSource": {"X": 0, "Y": 0, "Z": 0},
    "RegenerationModel": {
        "TiltVectorsUpdatesPerTempCycle": 0,
        "RegenerationModelUpdatesPerTempCycle": 0,
        "NumHiddenRegenerationNeurons": 0,
        "RegenerationModelInputBias": 1,
    },
    "ForwardModel": {"ForwardModelUpdatesPerTempCycle": 0},
    "Controller": {"ControllerUpdatesPerTempCycle": 0},
    "Signaling": {
        "SignalingUpdatesPerTempCycle": 0,
        "DepolarizationsPerTempCycle": 1,
        "RepolarizationsPerTempCycle": 1,
    },
}

GROWTH: Values = {
    "GrowthAmplitude": 0,
    "GrowthSpeedLimit": 0,
    "GreedyGrowth": 0,
    "GreedyThreshold": 0,
}

TASKS: Values = {"StickyFloor": 0, "BlockPushing": 0, "BlockMaterial": 0}

UNUSED = PaletteMaterial(
    code=1,
    youngs_modulus=1e6,
    poisson_ratio=0.35,
    density=1e6,
    expansion_coefficient=0.0,
    static_friction=1.0,
    dynamic_friction=0.5,
    name="unused",
)
"""Placeholder at positions of the palette that no voxel uses."""
