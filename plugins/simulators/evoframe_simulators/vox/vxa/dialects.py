"""Dialects of VXA files: programs that read the same tags by different rules.

Facts about the programs, from their sources:

- ``fork``: the paper's engine, ``reconfigurable_organisms``. Under water (``FluidEnvironment`` 1) it keeps
  gravity and floor. A voxel that would grow beyond three times its edge, or shrink below ``MinTempFact``,
  keeps its last size.
- ``evosoro`` has two engines, and ignores ``FloorSlope`` in both. ``_voxcad_land_water`` disables gravity and
  floor under water, and limits sizes only from below, at 0.1 of the edge; files with ``FluidEnvironment`` are
  for it. ``_voxcad`` has no water, and limits sizes to 1 + ``GrowthAmplitude``, in the manner of the fork.
- ``voxcraft``: ``voxcraft-sim`` stops by a formula, starts the actuation at time 0, and without
  ``EnableExpansion`` only lowers the temperature. It ignores water, the slope of the floor and
  ``MinTempFact``, and its laws of contacts and of friction are others than those of vox.
"""

from __future__ import annotations

import enum
from typing import Final, Literal, get_args

import attrs

from evoframe import ConfigurationError
from evoframe_simulators.vox.vxa.sections import Section

__all__ = ["DIALECTS", "Dialect", "Engine", "Reading", "recognize"]

Dialect = Literal["fork", "evosoro", "voxcraft"]

DIALECTS: Final[tuple[Dialect, ...]] = get_args(Dialect)

_ENVIRONMENT, _STOP = "Environment", "Simulator/StopCondition"

_MARKS: Final[dict[Dialect, tuple[str, ...]]] = {
    "voxcraft": (
        "GPU",
        "RawPrint",
        *(f"Simulator/{tag}" for tag in ("RecordHistory", "AttachDetach", "ForceField", "FitnessFunction")),
        *(f"Simulator/{tag}" for tag in ("EnableCilia", "EnableSignals", "EnableExpansion", "ThoroughTest")),
        f"{_STOP}/StopConditionFormula",
    ),
    "fork": (
        f"{_STOP}/ActuationStartTime",
        f"{_ENVIRONMENT}/Gravity/AlterGravityHalfway",
        *(
            f"{_ENVIRONMENT}/{tag}"
            for tag in ("RegenerationModel", "ForwardModel", "Controller", "Signaling")
        ),
        *(f"{_ENVIRONMENT}/{tag}" for tag in ("LightSource", "GrowthSpeedLimit", "GreedyGrowth")),
        *(f"{_ENVIRONMENT}/{tag}" for tag in ("GreedyThreshold", "SavePassiveData", "BlockPushing")),
        *(f"{_ENVIRONMENT}/{tag}" for tag in ("BlockMaterial", "ContractOnly", "ExpandOnly")),
    ),
    "evosoro": (
        *(f"{_STOP}/{tag}" for tag in ("AfterlifeTime", "MidLifeFreezeTime")),
        *(f"{_ENVIRONMENT}/{tag}" for tag in ("NormDistByVol", "SaveTraces", "NormalizationExponent")),
        *(f"{_ENVIRONMENT}/{tag}" for tag in ("MinGrowthTime", "GrowthModel", "BallisticSlowdownFact")),
        *(f"{_ENVIRONMENT}/{tag}" for tag in ("MaxSlowdownPermitted", "NumTimeStepsInWindow", "Sources")),
        *(f"{_ENVIRONMENT}/{tag}" for tag in ("NeedleInHaystack", "OnsetRelative", "FloorRadius")),
    ),
}
"""Tags that only one program writes. Files exported by evoframe have tags of ``fork`` and ``evosoro``, and
mean ``fork``, hence the order."""


class Engine(enum.Enum):
    """An engine with rules of its own."""

    FORK = "fork"
    EVOSORO_LAND = "evosoro's _voxcad"
    EVOSORO_WATER = "evosoro's _voxcad_land_water"
    VOXCRAFT = "voxcraft-sim"


@attrs.frozen
class Reading:
    """The rules by which a file is read.

    Attributes:
        dialect: Its dialect.
        engine: The engine of this dialect for which the file is meant.
        mark: Path of the tag that tells the dialect; empty if the user chose it or it is assumed.
        chosen: Whether the user chose the dialect.
    """

    dialect: Dialect
    engine: Engine
    mark: str = ""
    chosen: bool = False

    @property
    def assumed(self) -> bool:
        """Whether neither the user nor the file tells the dialect."""
        return not (self.mark or self.chosen)

    def described(self) -> str:
        """Return the rules and their reason, for a message."""
        engine = "" if self.engine.value == self.dialect else f" ({self.engine.value})"
        if self.chosen:
            reason = "chosen"
        else:
            reason = f"has {self.mark}" if self.mark else "assumed, since no tag tells"
        return f"read by the rules of {self.dialect}{engine}: {reason}"


def recognize(root: Section, chosen: str = "") -> Reading:
    """Return the rules for a file: those that the user chose, or those told by its tags, or the fork's.

    Args:
        root: The file.
        chosen: The dialect that the user chose, if any.

    Raises:
        ConfigurationError: There is no such dialect.
        InputError: A section with marks occurs more than once.
    """
    for dialect in DIALECTS:
        if chosen == dialect:
            return Reading(dialect, _engine(root, dialect), chosen=True)
    if chosen:
        problem = f"unknown dialect '{chosen}'; expected one of {', '.join(DIALECTS)}"
        raise ConfigurationError(problem, source="--dialect")
    for dialect, marks in _MARKS.items():
        mark = next((mark for mark in marks if _has(root, mark)), "")
        if mark:
            return Reading(dialect, _engine(root, dialect), mark)
    return Reading("fork", Engine.FORK)


def _engine(root: Section, dialect: Dialect) -> Engine:
    if dialect == "evosoro":
        water = root.get(_ENVIRONMENT).element.find("FluidEnvironment")
        return Engine.EVOSORO_LAND if water is None else Engine.EVOSORO_WATER
    return Engine.FORK if dialect == "fork" else Engine.VOXCRAFT


def _has(root: Section, path: str) -> bool:
    return root.element.find(path) is not None
