"""How far the runs of a study are."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from pathlib import Path
from typing import Literal, TypeAlias

import attrs

from evoframe.errors import InputError, LockedError
from evoframe.files import LARGEST_DOCUMENT, locked, parsed_json, read_text, write_json
from evoframe.record import CONFIG_FILE, open_run
from evoframe.runs import is_verified
from evoframe.study.plan import Planned
from evoframe.study.rows import Row, row_of

__all__ = ["FAILURE_FILE", "REMEDY", "Status", "forget_failure", "note_failure", "status_of", "with_remedy"]

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
        row: Its row, where it is done and the row was read.
    """

    state: State
    cause: str = ""
    verified: bool = True
    row: Row | None = attrs.field(default=None, eq=False, repr=False)

    @property
    def is_done(self) -> bool:
        """Whether there is a row of it."""
        return self.state in ("finished", "imported")

    @property
    def is_complete(self) -> bool:
        """Whether nothing is left to do."""
        return self.is_done and self.verified


@contextlib.contextmanager
def with_remedy() -> Iterator[None]:
    """Add to an error about a damaged run what to do."""
    try:
        yield
    except LockedError:
        raise  # nothing is damaged
    except InputError as error:
        error.add_note(REMEDY)
        raise


def status_of(planned: Planned, *, with_row: bool = False) -> Status:
    """Return how far a run is.

    Args:
        planned: The run.
        with_row: Whether to read its row, too, if it is finished.

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
        if run.configuration() != planned.deciding():
            raise InputError(
                f"{directory}: is a run of another study: its configuration is not that of "
                f"'{planned.label}'; choose another directory with --out"
            )
        if not run.finished():
            return Status("begun")
        verified = is_verified(run, planned.cell.config)
        return Status("finished", verified=verified, row=row_of(planned, run) if with_row else None)


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
        return str(parsed_json(read_text(path, LARGEST_DOCUMENT))["cause"])
    except InputError as error:
        if isinstance(error.__cause__, FileNotFoundError | NotADirectoryError):
            return None
        raise
    except (ValueError, KeyError, TypeError):
        return "unknown"
