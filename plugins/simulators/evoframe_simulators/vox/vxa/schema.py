"""Tags of the dialect, and the treatment of each in reading.

Files are interpreted like the fork ``reconfigurable_organisms`` of the old Voxelyze does. Facts about this
engine used here and in :mod:`~evoframe_simulators.vox.vxa.reading`, in addition to docs/physics.md:

- The engine takes the first of two equal tags where one is expected; a file with duplicates is rejected.
- In place of a missing section the engine uses defaults that differ from those of missing tags: without
  ``Gravity`` there are gravity and a floor, without ``Damping`` another slow damping. Such files fail.
- Under water (``FluidEnvironment`` 1) gravity and floor do not change.

Evosoro's engines differ: ``_voxcad_land_water`` disables gravity and floor under water, and ``_voxcad`` caps
the size of a voxel at 1 + ``GrowthAmplitude`` of the nominal one, so that 0 prevents expansion.

Rule for tags that vox does not simulate: a tag in the schema that enables a feature is rejected unless its
value is "off"; an unknown tag is rejected unless all its contents are empty, zero or ``false``. One error
reports all rejected tags of a file. Materials that no voxel uses are not checked.
"""

from __future__ import annotations

import enum
from collections.abc import Mapping
from typing import Final, TypeAlias

__all__ = ["MATERIAL", "REGION", "VXA", "Role", "Schema"]


class Role(enum.Enum):
    """Treatment of a tag."""

    READ = enum.auto()
    """The value determines an option of vox."""

    IDLE = enum.auto()
    """The value has no effect on the simulation: a name, a color, a file, a detail of a disabled feature."""

    UNSUPPORTED = enum.auto()
    """The tag enables a feature that vox does not simulate, whatever its value."""


Schema: TypeAlias = Mapping[str, "Schema | Role | float"]
"""Tag -> the schema of a section, the treatment of a value, or the only accepted number."""

READ: Final = Role.READ
IDLE: Final = Role.IDLE
UNSUPPORTED: Final = Role.UNSUPPORTED
OFF: Final = 0.0

MATERIAL: Final[Schema] = {
    "MatType": OFF,  # other types combine materials
    "Name": READ,
    "Display": IDLE,
    "Mechanical": {
        "MatModel": OFF,  # linear; other models yield or fail
        "Elastic_Mod": READ,
        "Plastic_Mod": IDLE,
        "Yield_Stress": IDLE,
        "FailModel": IDLE,
        "Fail_Stress": IDLE,
        "Fail_Strain": IDLE,
        "Density": READ,
        "Poissons_Ratio": READ,
        "CTE": READ,
        "MaterialTempPhase": IDLE,
        "IsConductive": IDLE,
        "IsPacemaker": IDLE,
        "uStatic": READ,
        "uDynamic": READ,
    },
}
"""Schema of a ``Material`` of the palette."""

REGION: Final[Schema] = {
    **dict.fromkeys(("PrimType", "X", "Y", "Z", "dX", "dY", "dZ", "DofFixed", "Fixed"), READ),
    **dict.fromkeys(("Radius", "R", "G", "B", "alpha"), IDLE),
    **{f"{what}{axis}": OFF for what in ("Force", "Torque", "Displace", "AngDisplace") for axis in "XYZ"},
}
"""Schema of an ``FRegion``: voxels that are clamped, pushed or moved."""

_SIMULATOR: Final[Schema] = {
    "Integration": {"Integrator": OFF, "DtFrac": READ},
    "Damping": {"BondDampingZ": READ, "ColDampingZ": READ, "SlowDampingZ": READ},
    "Collisions": {"SelfColEnabled": READ, "ColSystem": READ, "CollisionHorizon": READ},
    "Features": {
        "MaxVelLimitEnabled": OFF,
        "MaxVoxVelLimit": IDLE,
        "BlendingEnabled": OFF,
        "MixRadius": IDLE,
        "XMixRadius": IDLE,
        "YMixRadius": IDLE,
        "ZMixRadius": IDLE,
        "BlendModel": IDLE,
        "PolyExp": IDLE,
        "FluidDampEnabled": OFF,
        "PoissonKickBackEnabled": OFF,
        "VolumeEffectsEnabled": OFF,
        "EnforceLatticeEnabled": OFF,
        "PlasticityEnabled": OFF,
        "FailureEnabled": OFF,
    },
    "StopCondition": {
        "StopConditionType": READ,
        "StopConditionValue": READ,
        "InitCmTime": READ,
        "ActuationStartTime": READ,
        "AfterlifeTime": OFF,
        "MidLifeFreezeTime": OFF,
    },
    "EquilibriumMode": {"EquilibriumModeEnabled": OFF},
    "SurfMesh": IDLE,
    "GA": IDLE,
    "SimStop": IDLE,
    "ParentLifetime": IDLE,
    "MinTempFact": 0.1,
    # For variable stiffness and voxels that seek a source; both require tags that are rejected below.
    "MaxTempFactChange": IDLE,
    "DampEvolvedStiffness": IDLE,
    "MaxStiffnessChange": IDLE,
    "MinElasticMod": IDLE,
    "MaxElasticMod": IDLE,
}

_ENVIRONMENT: Final[Schema] = {
    "Boundary_Conditions": {"NumBCs": READ, "FRegion": REGION},
    "Fixed_Regions": {"NumFixed": READ, "FRegion": REGION},
    "Forced_Regions": {"NumForced": READ, "FRegion": REGION},
    "Gravity": {
        "GravEnabled": READ,
        "GravAcc": READ,
        "AlterGravityHalfway": 1.0,
        "FloorEnabled": READ,
        "FloorSlope": READ,
    },
    "Thermal": {
        "TempEnabled": READ,
        "TempAmp": READ,
        "TempAmplitude": READ,
        "TempBase": READ,
        "VaryTempEnabled": READ,
        "TempPeriod": READ,
    },
    "FluidEnvironment": READ,
    "AggregateDragCoefficient": READ,
    "NeuralNet": {
        "NeuralNetUpdatesPerTempCycle": OFF,
        "TouchSensorsEnabled": IDLE,
        "ProprioceptionSensorsEnabled": IDLE,
        "PacemakerSensorsEnabled": IDLE,
        "NumHiddenNeuronsPerLayer": IDLE,
        "NumHiddenLayers": IDLE,
        "OutputSmoothing": IDLE,
    },
    "RegenerationModel": {
        "TiltVectorsUpdatesPerTempCycle": IDLE,
        "RegenerationModelUpdatesPerTempCycle": OFF,
        "NumHiddenRegenerationNeurons": IDLE,
        "RegenerationModelInputBias": IDLE,
    },
    "ForwardModel": {"ForwardModelUpdatesPerTempCycle": OFF},
    "Controller": {"ControllerUpdatesPerTempCycle": OFF},
    "Signaling": {
        "SignalingUpdatesPerTempCycle": IDLE,
        "DepolarizationsPerTempCycle": IDLE,
        "RepolarizationsPerTempCycle": IDLE,
    },
    "LightSource": IDLE,
    "GrowthAmplitude": OFF,
    "GrowthSpeedLimit": IDLE,
    "GreedyGrowth": IDLE,
    "GreedyThreshold": IDLE,
    "BallisticSlowdownFact": IDLE,
    "MaxSlowdownPermitted": IDLE,
    "MinGrowthTime": IDLE,
    "TimeBetweenTraces": IDLE,
    "SaveTraces": IDLE,
    "SavePassiveData": IDLE,
    "NormDistByVol": IDLE,
    "NormalizationExponent": IDLE,
    "StickyFloor": OFF,
    "BlockPushing": OFF,
    "BlockMaterial": IDLE,
    "ContractOnly": OFF,
    "ExpandOnly": OFF,
    "FallingProhibited": OFF,  # ends the simulation when a body falls over
    "DampEvolvedStiffness": IDLE,
    "Sources": UNSUPPORTED,
    "FloorRadius": UNSUPPORTED,
}

_STRUCTURE: Final[Schema] = {
    **dict.fromkeys(("X_Voxels", "Y_Voxels", "Z_Voxels"), READ),
    "Data": {"Layer": READ},
    "PhaseOffset": {"Layer": READ},
    **{f"num{network}Synapses": OFF for network in ("RegenerationModel", "ForwardModel", "Controller")},
    **{
        f"{network}SynapseWeights": UNSUPPORTED
        for network in ("RegenerationModel", "ForwardModel", "Controller")
    },
    **dict.fromkeys(("FinalPhaseOffset", "InitialVoxelSize", "FinalVoxelSize"), UNSUPPORTED),
    **dict.fromkeys(("Stiffness", "StressAdaptationRate", "PressureAdaptationRate"), UNSUPPORTED),
    **dict.fromkeys(("VestibularContribution", "StressContribution", "PressureContribution"), IDLE),
    **{f"PreDamage{what}": IDLE for what in ("Roll", "Pitch", "Yaw", "Stress", "Pressure")},
}

VXA: Final[Schema] = {
    "Simulator": _SIMULATOR,
    "Environment": _ENVIRONMENT,
    "VXC": {
        "Lattice": {
            "Lattice_Dim": READ,
            **{f"{axis}_Dim_Adj": 1.0 for axis in "XYZ"},
            **{f"{axis}_{what}_Offset": OFF for axis in "XY" for what in ("Line", "Layer")},
        },
        "Voxel": {"Vox_Name": IDLE, **{f"{axis}_Squeeze": 1.0 for axis in "XYZ"}},
        "Palette": {"Material": MATERIAL},
        "Structure": _STRUCTURE,
    },
}
"""Schema of a file."""
