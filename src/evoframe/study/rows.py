"""The tables of a study: a row of final figures for each run, and their curves over the generations."""

from __future__ import annotations

import csv
import hashlib
import io
import json
import math
import re
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar

import attrs

from evoframe.errors import InputError
from evoframe.files import LARGEST_DOCUMENT, read_text, write_atomically
from evoframe.record import CHAMPION_FILE, Run, recorded_generations
from evoframe.study.plan import Planned, shown

__all__ = ["CURVES_FILE", "ROWS_FILE", "Row", "digest", "read_rows", "row_of", "score_curve", "write_rows"]

ROWS_FILE = "rows.csv"
CURVES_FILE = "curves.csv"
"""Table with two lines for each row, ``fitness`` and ``score``, with a value for each generation."""

T = TypeVar("T")


@attrs.frozen
class Row:
    """A finished run of a study.

    Attributes:
        settings: Dotted key -> value as text: the settings of the grid that define its cell.
        run: Number of the run within its cell, from 0.
        seed: Seed of the run.
        configuration: Digest of all tables that determine the result.
        evoframe: Version of evoframe that executed the run.
        fitness: Best fitness in the last generation; the aggregate of scores with that generation's
            collaborators.
        score: Score of the best pair, comparable between all cells.
        fittest_pair_score: Score of the pair of each population's fittest individual.
        pairs: Number of pairs scored.
        simulations: Number of pairs simulated; the others are repeats.
        seconds: Duration of all turns, s.
        champion: SHA-256 of champion.json.
        bit_generations: Components that had another bit generation than 1 when the run started, as in
            ``simulator=2``; separated by spaces.
        fitness_curve: Best fitness of any population, for each generation from 0.
        score_curve: Score of the best pair so far, for each generation from 0.
    """

    settings: Mapping[str, str]
    run: int
    seed: int
    configuration: str
    evoframe: str
    fitness: float
    score: float
    fittest_pair_score: float
    pairs: int
    simulations: int
    seconds: float
    champion: str
    bit_generations: str = ""
    fitness_curve: tuple[float, ...] = ()
    score_curve: tuple[float, ...] = ()

    def bit_generation(self, key: str) -> int:
        """Return the bit generation of the component with this dotted key."""
        return int(dict(part.split("=") for part in self.bit_generations.split()).get(key, 1))


_LARGEST_COUNT = 2**53  # a float, in which tables are analyzed, holds all smaller ones exactly


def _finite(text: str) -> float:
    value = float(text)
    if not math.isfinite(value):
        raise ValueError(f"expected a finite number, found {text}")
    return value


def _count(text: str) -> int:
    value = int(text)
    if not 0 <= value <= _LARGEST_COUNT:
        raise ValueError(f"expected a number from 0 to {_LARGEST_COUNT}, found {text[:30]}")
    return value


def _generations(text: str) -> str:
    for part in text.split():
        if not re.fullmatch(r"[^=]+=[1-9][0-9]{0,8}", part):
            raise ValueError(f"expected bit generations as in simulator=2, found {part[:30]}")
    return text


_COLUMNS: Mapping[str, Callable[[str], Any]] = {
    "run": int,
    "seed": int,
    "configuration": str,
    "evoframe": str,
    "fitness": _finite,
    "score": _finite,
    "fittest_pair_score": _finite,
    "pairs": _count,
    "simulations": _count,
    "seconds": _finite,
    "champion": str,
    "bit_generations": _generations,
}
_ADDED_LATER = "bit_generations"  # only in tables of runs that have some
_REQUIRED = tuple(name for name in _COLUMNS if name != _ADDED_LATER)


def digest(planned: Planned) -> str:
    """Return the digest of all tables that determine the result of a run."""
    text = json.dumps(planned.deciding(), sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def row_of(planned: Planned, run: Run) -> Row:
    """Return the row of a finished run.

    Args:
        planned: The run in the study.
        run: The finished run.

    Raises:
        InputError: The run is damaged.
    """
    work, summary = run.workload(), run.summary()
    fitness, score = _fitness_curve(run), score_curve(run)
    return Row(
        settings={key: shown(value) for key, value in planned.cell.settings},
        run=planned.index,
        seed=planned.seed,
        configuration=digest(planned),
        evoframe=str(run.config.get("provenance", {}).get("evoframe", "")),
        fitness=fitness[-1],
        score=summary["best_pair_score"],
        fittest_pair_score=summary["fittest_pair_score"],
        pairs=sum(row["pairs"] for row in work),
        simulations=sum(row["simulations"] for row in work),
        seconds=round(sum(row["seconds"] for row in work), 3),
        champion=_digest_of(run.directory / CHAMPION_FILE),
        bit_generations=_generations_in(run, planned),
        fitness_curve=fitness,
        score_curve=score,
    )


def _generations_in(run: Run, planned: Planned) -> str:
    recorded, components = recorded_generations(run), dict(planned.cell.config.components())
    return " ".join(f"{key}={recorded[key]}" for key in components if recorded.get(key, 1) != 1)


def _digest_of(path: Path) -> str:
    try:
        return hashlib.sha256(path.read_bytes()).hexdigest()
    except OSError as error:
        raise InputError(f"cannot be read: {error.strerror}", source=path) from error


def _turns_in_a_generation(run: Run) -> int:
    if run.config["run"].get("timing") == "parallel":
        return 1
    return sum(table.get("turns", 1) for table in run.config["populations"].values())


def _fitness_curve(run: Run) -> tuple[float, ...]:
    best: dict[int, float] = {}
    turns = _turns_in_a_generation(run)
    for row in run.turns():
        generation = -(-row["turn"] // turns)
        best[generation] = max(row["best"], best.get(generation, row["best"]))
    return tuple(best[generation] for generation in sorted(best))


def score_curve(run: Run) -> tuple[float, ...]:
    """Return the best score so far at the end of each generation, in which each population has its turns.

    That of the final pair belongs to the last generation.
    """
    turns, last = _turns_in_a_generation(run), len(run.workload()) - 1
    ends = [*range(0, last + 1, turns)]
    if last > run.config["run"]["generations"] * turns:
        ends = [*range(0, last - 1, turns), last]
    found = run.table("best_pairs")
    return tuple(
        max((row["score"] for row in found if row["turn"] <= end), default=float("nan")) for end in ends
    )


def write_rows(rows: Sequence[Row], path: Path) -> None:
    """Write rows as a table, and their curves as ``curves.csv`` in the same folder.

    Raises:
        RunError: A file cannot be written.
    """
    keys = list(dict.fromkeys(key for row in rows for key in row.settings))
    columns = _COLUMNS if any(row.bit_generations for row in rows) else _REQUIRED
    figures = [[getattr(row, name) for name in columns] for row in rows]
    table = [[*_settings(row, keys), *values] for row, values in zip(rows, figures, strict=True)]
    write_atomically(path, _csv([*keys, *columns], table))
    length = max((len(row.fitness_curve) for row in rows), default=0)
    curves = [
        [*_settings(row, keys), row.run, name, *map(_short, curve), *[""] * (length - len(curve))]
        for row in rows
        for name, curve in (("fitness", row.fitness_curve), ("score", row.score_curve))
        if curve
    ]
    generations = range(length)
    write_atomically(path.with_name(CURVES_FILE), _csv([*keys, "run", "curve", *generations], curves))


def _short(value: float) -> str:
    """Return a value of a curve as text, with six significant digits."""
    return f"{value:.6g}"


def _settings(row: Row, keys: Iterable[str]) -> list[str]:
    return [row.settings.get(key, "") for key in keys]


_LINE_END = "\r\n"  # so that the writer quotes values that contain either character


def _csv(columns: Sequence[Any], lines: Iterable[Sequence[Any]]) -> bytes:
    """Return a table whose lines end with a line feed, as Unix tools expect."""
    table = []
    for line in (columns, *lines):
        text = io.StringIO()
        csv.writer(text, lineterminator=_LINE_END).writerow(line)
        table.append(text.getvalue().removesuffix(_LINE_END))
    return "\n".join([*table, ""]).encode()


def read_rows(path: Path) -> list[Row]:
    """Return the rows of a table, with their curves if ``curves.csv`` is in the same folder.

    Raises:
        InputError: A file cannot be read, or is not a table of rows or curves.
    """
    curves = path.with_name(CURVES_FILE)
    drawn = _curves(curves) if curves.is_file() else {}
    rows = []
    for number, line in enumerate(_table(path, _REQUIRED), start=2):
        settings = {key: value for key, value in line.items() if key not in _COLUMNS}
        try:
            figures = {name: kind(line[name]) for name, kind in _COLUMNS.items() if name in line}
        except ValueError as error:
            raise InputError(f"not a row of a study: {error}", source=path, key=f"line {number}") from error
        row = Row(settings, **figures)
        own = {name: drawn.get((tuple(settings.items()), row.run, name), ()) for name in ("fitness", "score")}
        for name, curve in own.items():
            if curve and _short(curve[-1]) != _short(getattr(row, name)):
                raise InputError(
                    f"{path.name}, line {number}: the {name} is {_short(getattr(row, name))}, but its curve "
                    f"ends at {_short(curve[-1])}",
                    source=curves,
                )
        rows.append(attrs.evolve(row, fitness_curve=own["fitness"], score_curve=own["score"]))
    return rows


def _table(path: Path, columns: Collection[str]) -> list[dict[str, str]]:
    try:
        text = io.StringIO(read_text(path, LARGEST_DOCUMENT), newline="")  # any line ends
        reader = csv.DictReader(text, strict=True)
        lines, there = list(reader), reader.fieldnames or ()
    except csv.Error as error:
        raise InputError(f"not a CSV table: {error}", source=path) from error
    if any(None in line or None in line.values() for line in lines):
        raise InputError("not a CSV table: its lines differ in the number of columns", source=path)
    if lacking := [name for name in columns if name not in there]:
        raise InputError(f"not a table of a study: missing columns: {', '.join(lacking)}", source=path)
    return lines


def _curves(path: Path) -> dict[tuple[Any, ...], tuple[float, ...]]:
    found = {}
    for number, line in enumerate(_table(path, ("run", "curve")), start=2):
        generations = [key for key in line if key.isdecimal()]
        settings = tuple(
            (key, value) for key, value in line.items() if key not in ("run", "curve", *generations)
        )
        try:
            values = tuple(_finite(line[key]) for key in generations if line[key])
            found[settings, int(line["run"]), line["curve"]] = values
        except (KeyError, ValueError) as error:
            raise InputError(f"not a curve of a study: {error}", source=path, key=f"line {number}") from error
    return found
