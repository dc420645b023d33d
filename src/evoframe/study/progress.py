"""How far the runs of a study are."""

from __future__ import annotations

import contextlib
import json
from pathlib import Path
from typing import Literal, TypeAlias

import attrs

from evoframe.errors import InputError, LockedError
from evoframe.files.locks import locked
from evoframe.files.reading import read_text
from evoframe.files.writing import write_json
from evoframe.record.layout import CONFIG_FILE
from evoframe.record.run import open_run
from evoframe.runs.resuming import is_verified
from evoframe.study.plan import Planned

__all__ = ["FAILURE_FILE", "REMEDY", "Status", "forget_failure", "note_failure", "status"]

REMEDY = "a run whose directory is removed is made again"
"""What to do about one that is damaged."""

FAILURE_FILE = "failure.json"
"""In the directory of a run that failed: why."""

State: TypeAlias = Literal["missing", "begun", "failed", "finished", "imported"]


@attrs.frozen
class Status:
    """How far a run is.

    Attributes:
        state: ``missing``, ``begun``, ``failed``, ``finished``, or ``imported``: its row came from elsewhere.
        cause: Why it failed.
        verified: Where it is finished: whether its champion was verified, or cannot be.
    """

    state: State
    cause: str = ""
    verified: bool = True

    @property
    def is_done(self) -> bool:
        """Whether there is a row of it."""
        return self.state in ("finished", "imported")

    @property
    def is_complete(self) -> bool:
        """Whether nothing is left to do."""
        return self.is_done and self.verified


def status(planned: Planned) -> Status:
    """Return how far a run is.

    Raises:
        InputError: Its directory is damaged, or holds the run of another study.
    """
    directory = planned.directory
    cause = _cause(directory / FAILURE_FILE)
    if cause is not None:
        return Status("failed", cause)
    if not (directory / CONFIG_FILE).is_file():
        return Status("missing")
    with open_run(directory) as run:
        if not run.begun:
            return Status("begun")
        _refuse_another(planned, run.configuration())
        if not run.finished():
            return Status("begun")
        return Status("finished", verified=is_verified(run, planned.cell.config))


def note_failure(directory: Path, cause: str) -> None:
    """Note why a run failed, so that it is not begun again before somebody asks for that.

    Nothing is noted where another process is at it already, nor where another one has noted its cause.

    Raises:
        InputError: The directory cannot be written.
        RunError: The file cannot be written.
    """
    path = directory / FAILURE_FILE
    directory.mkdir(parents=True, exist_ok=True)
    with contextlib.suppress(LockedError), locked(directory):
        if not path.exists():
            write_json(path, {"cause": cause})


def forget_failure(directory: Path) -> None:
    """Let a run that failed be tried again."""
    (directory / FAILURE_FILE).unlink(missing_ok=True)


def _cause(path: Path) -> str | None:
    """Return why a run failed; ``None`` if it has not, or another process has just begun it again."""
    try:
        return str(json.loads(read_text(path, 1))["cause"])
    except InputError as error:
        if isinstance(error.__cause__, FileNotFoundError | NotADirectoryError):
            return None
        raise
    except (ValueError, KeyError, TypeError):
        return "unknown"


def _refuse_another(planned: Planned, configuration: object) -> None:
    if configuration != planned.deciding():
        raise InputError(
            f"{planned.directory}: is a run of another study: its configuration is not that of "
            f"'{planned.label}'; choose another directory with --out"
        )
