"""The tags of the dialect, and what becomes of each when a file is read.

A file is read as the fork ``reconfigurable_organisms`` of the old Voxelyze reads it. Facts about this engine
that are used here and in :mod:`~evoframe_simulators.vox.vxa.reading`, beside those of physics.md:

- A tag that stands alone in its section is looked for by name; of two with one name the engine takes the
  first, so a file with two is refused.
- Sections that are missing leave the engine's own defaults, which are not those of missing tags: without
  ``Gravity`` there is gravity and a floor, without ``Damping`` another slow damping. Such files are refused.
- Under water (``FluidEnvironment`` 1) gravity and floor stay as they are.

Evosoro's engines differ: ``_voxcad_land_water`` switches gravity and floor off under water, and ``_voxcad``
caps the size of a voxel at 1 + ``GrowthAmplitude`` of the nominal one, which with 0 leaves no expansion.

The rule for tags that vox does not simulate: a tag that the schema knows to switch something on is refused
unless it has its value for "off"; a tag that it does not know is refused unless all that it holds is empty, a
zero or ``false``. All of a file's refusals make one message. Materials that no voxel has are not looked at.
"""

from __future__ import annotations

import enum
from collections.abc import Mapping
from typing import Final, TypeAlias

__all__ = ["MATERIAL", "REGION", "VXA", "Role", "Schema"]


class Role(enum.Enum):
    """What becomes of a tag's value."""

    READ = enum.auto()
    """It is an option of vox."""

    IDLE = enum.auto()
    """It changes nothing that is simulated: a name, a colour, a file, a detail of what is off or not read."""

    REFUSED = enum.auto()
    """Whatever it holds, it switches on what vox does not simulate."""


Schema: TypeAlias = Mapping[str, "Schema | Role | float"]
"""Tag -> the tags of a section, what becomes of a value, or the only number that a value may be."""

READ: Final = Role.READ
IDLE: Final = Role.IDLE
REFUSED: Final = Role.REFUSED
OFF: Final = 0.0

MATERIAL: Final[Schema] = {
    "MatType": OFF,  # others are made of further materials
    "Name": READ,
    "Display": IDLE,
    "Mechanical": {
        "MatModel": OFF,  # linear; others yield or fail
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
"""One ``Material`` of the palette."""

REGION: Final[Schema] = {
    **dict.fromkeys(("PrimType", "X", "Y", "Z", "dX", "dY", "dZ", "DofFixed", "Fixed"), READ),
    **dict.fromkeys(("Radius", "R", "G", "B", "alpha"), IDLE),
    **{f"{what}{axis}": OFF for what in ("Force", "Torque", "Displace", "AngDisplace") for axis in "XYZ"},
}
"""One ``FRegion``: voxels that are held, pushed or moved."""

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
    # Of stiffness that changes and of voxels that seek a source, which need what is refused below.
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
    "Sources": REFUSED,
    "FloorRadius": REFUSED,
}

_STRUCTURE: Final[Schema] = {
    **dict.fromkeys(("X_Voxels", "Y_Voxels", "Z_Voxels"), READ),
    "Data": {"Layer": READ},
    "PhaseOffset": {"Layer": READ},
    **{f"num{network}Synapses": OFF for network in ("RegenerationModel", "ForwardModel", "Controller")},
    **{
        f"{network}SynapseWeights": REFUSED for network in ("RegenerationModel", "ForwardModel", "Controller")
    },
    **dict.fromkeys(("FinalPhaseOffset", "InitialVoxelSize", "FinalVoxelSize"), REFUSED),
    **dict.fromkeys(("Stiffness", "StressAdaptationRate", "PressureAdaptationRate"), REFUSED),
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
"""The whole of a file."""
