"""Finished and unfinished runs, read back from their directories."""

from __future__ import annotations

import contextlib
import json
import sqlite3
import tomllib
from pathlib import Path
from typing import Any

import attrs

from evoframe.champion import FORMAT, champion_from_json, parsed_json
from evoframe.errors import InputError
from evoframe.values import Design
from evoframe.verification import VERIFICATION_FILE, Verification, verification_from_json

__all__ = ["Champion", "Run", "load_run"]


@attrs.frozen(eq=False)
class Champion:
    """The best pair that was really simulated.

    Attributes:
        score: What the objective gave; a displacement in metres with all built-in objectives.
        design: Body and controller.
        simulation: The tables ``simulator`` and ``objective`` that it was simulated with.
    """

    score: float
    design: Design
    simulation: dict[str, Any]


@attrs.frozen
class Run:
    """A run's directory.

    Attributes:
        directory: Where it is.
        config: The resolved configuration, as TOML tables.
    """

    directory: Path
    config: dict[str, Any]

    @property
    def turns(self) -> list[dict[str, Any]]:
        """One row for each population that was judged in a turn: best, best_so_far, mean, ..."""
        return self.table("turns")

    @property
    def individuals(self) -> list[dict[str, Any]]:
        """One row for each individual of each turn."""
        return self.table("individuals")

    @property
    def pairs(self) -> list[dict[str, Any]]:
        """One row for each pair that was scored."""
        return self.table("pairs")

    @property
    def workload(self) -> list[dict[str, Any]]:
        """One row for each turn: pairs, simulations, seconds."""
        return self.table("workload")

    @property
    def summary(self) -> dict[str, Any]:
        """The final figures; empty as long as the run is not finished."""
        rows = {row["key"]: row["value"] for row in self.table("meta") if row["key"] != "format"}
        return {key: json.loads(value) for key, value in rows.items()}

    @property
    def champion(self) -> Champion:
        """The best pair so far.

        Raises:
            InputError: There is none yet, or the database is damaged.
        """
        path = self.directory / "run.db"
        rows = self.table("best_pairs")
        if not rows:
            raise InputError(f"{path}: has no pair with a score yet")
        try:
            design, simulation, score = champion_from_json(rows[-1]["document"])
        except ValueError as error:
            raise InputError(f"{path}: best_pairs: {error}") from error
        return Champion(score, design, simulation)

    @property
    def verification(self) -> Verification | None:
        """What became of the champion with one thing changed at a time; ``None`` if nobody has looked.

        Raises:
            InputError: The file is damaged, or is about another champion.
        """
        path = self.directory / VERIFICATION_FILE
        try:
            verification = verification_from_json(parsed_json(path.read_text(encoding="utf-8")))
        except FileNotFoundError:
            return None
        except OSError as error:
            raise InputError(f"{path}: cannot be read: {error.strerror}") from error
        except ValueError as error:
            raise InputError(f"{path}: {error}; {self._verify_again}") from error
        if verification.score != self.champion.score:
            raise InputError(f"{path}: is about another champion; {self._verify_again}")
        return verification

    @property
    def _verify_again(self) -> str:
        return f"to make it anew: evoframe verify {self.directory}"

    def table(self, name: str) -> list[dict[str, Any]]:
        """Return the rows of a table of the database, in the order of their keys.

        Raises:
            InputError: The database cannot be read, or has no such table.
        """
        path = self.directory / "run.db"
        try:
            with contextlib.closing(_open(path)) as database:
                names = [row["name"] for row in database.execute("SELECT name FROM sqlite_master")]
                if name not in names:
                    raise InputError(f"{path}: has no table '{name}'; tables: {', '.join(sorted(names))}")
                return [dict(row) for row in database.execute(f'SELECT * FROM "{name}"')]  # noqa: S608
        except sqlite3.Error as error:
            raise InputError(f"{path}: cannot be read: {error}") from error


def load_run(directory: str | Path) -> Run:
    """Return the run in *directory*.

    Raises:
        InputError: It is no run's directory, or one of another format.
    """
    directory = Path(directory)
    path = directory / "config.toml"
    try:
        config = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise InputError(f"{directory}: is no run's directory: {path.name}: {error.strerror}") from error
    except ValueError as error:
        raise InputError(f"{path}: not valid TOML: {error}") from error
    run = Run(directory, config)
    formats = [row["value"] for row in run.table("meta") if row["key"] == "format"]
    if formats != [str(FORMAT)]:
        raise InputError(f"{directory}: has the format {formats}, but this evoframe reads format {FORMAT}")
    return run


def _open(path: Path) -> sqlite3.Connection:
    if not path.is_file():
        raise InputError(f"{path}: there is no such file")
    database = sqlite3.connect(f"{path.absolute().as_uri()}?mode=ro", uri=True)
    database.row_factory = sqlite3.Row
    return database
