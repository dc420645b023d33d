"""Status of the runs of a study."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from pathlib import Path
from typing import Literal, TypeAlias

import attrs

from evoframe.errors import InputError, LockedError
from evoframe.files import LARGEST_DOCUMENT, encodable, locked, parsed_json, read_text, write_json
from evoframe.record import CONFIG_FILE, open_run
from evoframe.runs import is_verified
from evoframe.study.plan import Planned
from evoframe.study.rows import Row, row_of

__all__ = ["FAILURE_FILE", "REMEDY", "Status", "clear_failure", "record_failure", "status_of", "with_remedy"]

REMEDY = "to repeat this run, remove its directory and rerun the study"
"""Hint for a damaged run."""

FAILURE_FILE = "failure.json"
"""File with the cause, in the directory of a failed run."""

State: TypeAlias = Literal["missing", "begun", "failed", "finished", "imported"]


@attrs.frozen
class Status:
    """Status of a run.

    Attributes:
        state: ``missing``, ``begun``, ``failed``, ``finished``, or ``imported`` from another session.
        cause: Cause of a failure.
        verified: False for a finished run whose champion is still to be verified.
        row: Row of a finished or imported run, if it was read.
    """

    state: State
    cause: str = ""
    verified: bool = True
    row: Row | None = attrs.field(default=None, eq=False, repr=False)

    @property
    def is_done(self) -> bool:
        """True if the run has a row."""
        return self.state in ("finished", "imported")

    @property
    def is_complete(self) -> bool:
        """True if the run is done and verified."""
        return self.is_done and self.verified


@contextlib.contextmanager
def with_remedy() -> Iterator[None]:
    """Add the hint to errors about a damaged run."""
    try:
        yield
    except LockedError:
        raise  # the run is locked, not damaged
    except InputError as error:
        error.add_note(REMEDY)
        raise


def status_of(planned: Planned, *, with_row: bool = False) -> Status:
    """Return the status of a run.

    Args:
        planned: The run.
        with_row: Whether to read the row of a finished run too.

    Raises:
        InputError: Its directory is damaged, or holds a run of another study.
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
        if run.configuration() != planned.deciding():
            raise InputError(
                f"belongs to another study: its configuration is not that of '{planned.label}'; choose "
                "another directory with --out",
                source=directory,
            )
        if not run.finished():
            return Status("begun")
        verified = is_verified(run, planned.cell.config)
        return Status("finished", verified=verified, row=row_of(planned, run) if with_row else None)


def record_failure(directory: Path, cause: str) -> None:
    """Record the cause of a failed run, so that it starts again only with ``--retry``.

    Nothing is recorded if another process executes the run, or has recorded a cause before.

    Raises:
        InputError: The directory is not writable.
        RunError: The file cannot be written.
    """
    path = directory / FAILURE_FILE
    directory.mkdir(parents=True, exist_ok=True)
    with contextlib.suppress(LockedError), locked(directory):
        if not path.exists():
            write_json(path, {"cause": encodable(cause)})


def clear_failure(directory: Path) -> None:
    """Remove the record of a failure, so that the run starts again."""
    (directory / FAILURE_FILE).unlink(missing_ok=True)


def _cause(path: Path) -> str | None:
    """Return the cause of a failed run; ``None`` if it has not failed or another process is retrying it."""
    try:
        return str(parsed_json(read_text(path, LARGEST_DOCUMENT))["cause"])
    except InputError as error:
        if isinstance(error.__cause__, FileNotFoundError | NotADirectoryError):
            return None
        raise
    except (ValueError, KeyError, TypeError):
        return "unknown"
