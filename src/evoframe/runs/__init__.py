"""Runs from start to end: starting, executing, resuming and checking."""

from evoframe.runs.doctor import Check, State, check_installation, check_run
from evoframe.runs.execution import Execution, verify_champion
from evoframe.runs.restoring import configuration_of
from evoframe.runs.resuming import (
    is_finished,
    is_verified,
    reopen,
    resume,
    verify_if_missing,
)
from evoframe.runs.starting import prepare, run

__all__ = [
    "Check",
    "Execution",
    "State",
    "check_installation",
    "check_run",
    "configuration_of",
    "is_finished",
    "is_verified",
    "prepare",
    "reopen",
    "resume",
    "run",
    "verify_champion",
    "verify_if_missing",
]
