"""Tags of VXA files, and the treatment of each in reading.

Facts about the engines used here and in :mod:`~evoframe_simulators.vox.vxa.reading`, in addition to
docs/physics.md and :mod:`.dialects`:

- An engine takes the first of two equal tags where one is expected; a file with duplicates is rejected.
- In place of a missing section it uses defaults that differ from those of missing tags: without ``Gravity``
  there are gravity and a floor, without ``Damping`` another slow damping.
- The fork only uses ``GrowthAmplitude`` together with sizes of single voxels, which are rejected.

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
        # Of voxcraft: materials that are held, and details of features that are off.
        **dict.fromkeys(("Fixed", "LockZ", "sticky"), OFF),
        **dict.fromkeys(("Cilia", "isMeasured", "isTarget", "isPaceMaker", "PaceMakerPeriod"), IDLE),
        **dict.fromkeys(("signalValueDecay", "signalTimeDelay", "inactivePeriod"), IDLE),
    },
}
"""Schema of a ``Material`` of the palette."""

REGION: Final[Schema] = {
    **dict.fromkeys(("PrimType", "X", "Y", "Z", "dX", "dY", "dZ", "DofFixed", "Fixed"), READ),
    **dict.fromkeys(("Name", "Radius", "R", "G", "B", "alpha"), IDLE),
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
        "StopConditionFormula": READ,
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
    "MinTempFact": READ,
    # For variable stiffness and voxels that seek a source; both require tags that are rejected below.
    "MaxTempFactChange": IDLE,
    "DampEvolvedStiffness": IDLE,
    "MaxStiffnessChange": IDLE,
    "MinElasticMod": IDLE,
    "MaxElasticMod": IDLE,
    # Of voxcraft.
    "AttachDetach": {
        "EnableCollision": READ,
        "EnableAttach": OFF,
        "EnableDetach": OFF,
        **dict.fromkeys(("CollisionMode", "watchDistance", "boundingRadius", "SafetyGuard"), IDLE),
        **dict.fromkeys(("AttachCondition", "KeepJustOneIfManyHaveSameGroupPosition"), IDLE),
    },
    "EnableExpansion": READ,
    **dict.fromkeys(("EnableCilia", "EnableSignals", "SecondaryExperiment", "SelfReplication"), OFF),
    **dict.fromkeys(("RecordHistory", "FitnessFunction", "ThoroughTest", "EnableTargetCloseness"), IDLE),
    **dict.fromkeys(("SavePositionOfAllVoxels", "MaxDistInVoxelLengthsToCountAsPair"), IDLE),
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
    "GrowthAmplitude": READ,  # limits sizes in evosoro
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
    "StickyFloor": READ,
    "BlockPushing": OFF,
    "BlockMaterial": IDLE,
    **dict.fromkeys(("ContractOnly", "ExpandOnly", "FallingProhibited"), READ),
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
    **dict.fromkeys(("BaseCiliaForce", "ShiftCiliaForce"), IDLE),  # without cilia
}

VXA: Final[Schema] = {
    "Simulator": _SIMULATOR,
    "Environment": _ENVIRONMENT,
    **dict.fromkeys(("GPU", "RawPrint"), IDLE),  # of voxcraft
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
