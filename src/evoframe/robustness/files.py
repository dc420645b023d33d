"""The directory of a robustness measurement, with its setting and its exact scores."""

from __future__ import annotations

import csv
import hashlib
import io
import json
import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import attrs
import numpy as np
from attrs.validators import ge

from evoframe.documents import differences, structure, unstructure
from evoframe.errors import InputError
from evoframe.files import is_file, parsed_json, read_text, write_atomically
from evoframe.robustness.measurement import Body, Divergence, Robustness, Setting

__all__ = [
    "SCORES_FILE",
    "SETTING_FILE",
    "document_of",
    "read_robustness",
    "refuse_another",
    "scores_text",
    "write_measurement",
]

SETTING_FILE = "robustness.json"
"""The setting of a measurement, and the simulations that diverged."""

SCORES_FILE = "scores.csv"
"""Table of scores, a line for each controller and a column for each body; diverged simulations are empty."""

_FORMAT = 1
_LARGEST = 256  # MiB
_FIRST = "controller"  # heading of the first column


def write_measurement(measured: Robustness, directory: Path) -> list[Path]:
    """Write all scores, and their setting.

    Args:
        measured: The measurement.
        directory: An existing directory; files of an earlier measurement are overwritten.

    Returns:
        Paths of the files.

    Raises:
        RunError: A file cannot be written.
    """
    texts = {
        SCORES_FILE: scores_text(measured),
        SETTING_FILE: f"{json.dumps(document_of(measured), indent=1)}\n",
    }
    for name, text in texts.items():
        write_atomically(directory / name, text.encode())
    return [directory / name for name in texts]


def document_of(measured: Robustness) -> dict[str, Any]:
    """Return the setting of a measurement, and the simulations that diverged, as JSON values."""
    setting = measured.setting
    lost = [_Lost(each.controller, setting.bodies[each.body].label, each.step) for each in measured.diverged]
    document: dict[str, Any] = unstructure(
        _Document(
            **attrs.asdict(setting, recurse=False),
            format=_FORMAT,
            diverged=tuple(lost),
            scores_sha256=hashlib.sha256(scores_text(measured).encode()).hexdigest(),
        )
    )
    return document


def refuse_another(directory: Path, setting: Setting, *, force: bool = False) -> None:
    """Check that a directory is missing or empty, or contains a measurement with the same setting.

    Args:
        directory: Directory for a new measurement.
        setting: Setting of the new measurement.
        force: Whether to overwrite a measurement that is damaged or has another setting.

    Raises:
        InputError: The directory contains something else, or a measurement with another setting.
    """
    path = directory / SETTING_FILE
    try:
        occupied = directory.exists() and any(directory.iterdir())
    except OSError as error:
        raise InputError(f"cannot be used for a measurement: {error.strerror}", source=directory) from error
    if not occupied:
        return
    if not is_file(path):
        raise InputError(
            f"directory is not empty and has no {SETTING_FILE}; choose another directory with --out",
            source=directory,
        )
    if force:
        return
    there = _document(path).setting
    alike = [body.label for body in there.bodies] == [body.label for body in setting.bodies]
    lines = differences(_compared(there, labelled=alike), _compared(setting, labelled=alike))
    if lines:
        listed = "\n  ".join(lines)
        raise InputError(
            "measured with other settings; choose another directory with --out, or overwrite it with "
            f"--force:\n  {listed}",
            source=path,
        )


def read_robustness(directory: str | Path) -> Robustness:
    """Read the measurement that :func:`write_measurement` wrote.

    Raises:
        InputError: The measurement is missing or damaged.
    """
    path = Path(directory) / SETTING_FILE
    if not is_file(path):
        raise InputError(
            f"not a measurement of robustness: {SETTING_FILE} is missing; choose a directory that evoframe "
            "robustness wrote",
            source=directory,
        )
    found = _document(path)
    path = Path(directory) / SCORES_FILE
    text = read_text(path, _LARGEST)
    try:
        scores = _read_scores(text, found)
    except (ValueError, csv.Error) as error:
        raise InputError(f"not as evoframe writes it: {error}", source=path) from error
    if found.scores_sha256 not in _digests(text):
        raise InputError(
            f"its SHA-256 is not the one recorded in {SETTING_FILE}; repeat the measurement with --force",
            source=path,
        )
    scores.setflags(write=False)
    return Robustness(found.setting, scores, found.divergences())


def _digests(text: str) -> set[str]:
    """Return the SHA-256 of a table, and of the same with the line ends that evoframe writes."""
    ends = "\r\n" if "\n" in text else "\r"  # of Windows, or of old Macs
    texts = (text, text.replace(ends, "\n"))
    return {hashlib.sha256(each.encode()).hexdigest() for each in texts}


def _compared(setting: Setting, *, labelled: bool) -> dict[str, Any]:
    """Return the setting as tables in which each body has its own key.

    Bodies are compared by digest and group, so a run that was moved still counts as the same body. The keys
    are labels if *labelled* (if both settings have the same labels), and numbers if not.
    """
    groups = list(setting.groups)
    bodies = {
        body.label if labelled else str(number): f"{body.digest[:16]} in group {groups.index(body.group) + 1}"
        for number, body in enumerate(setting.bodies, start=1)
    }
    return {**unstructure(setting), "bodies": bodies}


@attrs.frozen
class _Lost:
    """A simulation that diverged, in the format of the setting's file."""

    controller: int = attrs.field(validator=ge(0))
    body: str
    step: int = attrs.field(validator=ge(0))


@attrs.frozen
class _Document:
    """The file of a setting: the fields of :class:`Setting`, and those that describe the scores."""

    format: int
    seed: int = attrs.field(validator=ge(0))
    controllers: int = attrs.field(validator=ge(1))
    unit: str
    simulation: dict[str, Any]
    bodies: tuple[Body, ...]
    diverged: tuple[_Lost, ...]
    scores_sha256: str

    @property
    def setting(self) -> Setting:
        return Setting(self.seed, self.controllers, self.unit, self.simulation, self.bodies)

    def divergences(self) -> tuple[Divergence, ...]:
        """Return the rows and columns of the missing scores.

        Raises:
            ValueError: There are no bodies, two have the same label, or a label is unknown.
        """
        columns = {body.label: column for column, body in enumerate(self.bodies)}
        if not 0 < len(columns) == len(self.bodies):
            raise ValueError("bodies: expected one or more, with different labels")
        if strange := [lost.body for lost in self.diverged if lost.body not in columns]:
            raise ValueError(f"diverged: {strange[0]!r} is not one of the bodies")
        return tuple(Divergence(lost.controller, columns[lost.body], lost.step) for lost in self.diverged)


def _document(path: Path) -> _Document:
    try:
        document = parsed_json(read_text(path, _LARGEST))
        if not isinstance(document, Mapping) or "bodies" not in document:
            raise ValueError("not a measurement of robustness")  # noqa: TRY301 - as all others
        if document.get("format") is True or document.get("format") != _FORMAT:
            found = document.get("format")
            raise ValueError(f"format: expected {_FORMAT}, found {found!r}")  # noqa: TRY301 - as all others
        try:
            described = structure(document, _Document, ())
            described.divergences()
        except ValueError as error:
            raise ValueError(f"not as evoframe writes it: {error}") from error
    except ValueError as error:
        raise InputError(str(error), source=path) from error
    return described


def scores_text(measured: Robustness) -> str:
    """Return the table of all scores as CSV, with all digits."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([_FIRST, *(body.label for body in measured.setting.bodies)])
    for number, row in enumerate(measured.scores.tolist()):
        writer.writerow([number, *("" if math.isnan(score) else repr(score) for score in row)])
    return text.getvalue()


def _read_scores(text: str, found: _Document) -> np.ndarray[Any, np.dtype[np.float64]]:
    setting = found.setting
    header, *rows = [*csv.reader(io.StringIO(text, newline=""))] or [[]]
    if header != [_FIRST, *(body.label for body in setting.bodies)]:
        raise ValueError(f"columns differ from the bodies in {SETTING_FILE}")
    numbers = [row[0] if row else "" for row in rows]
    if len(rows) != setting.controllers or numbers != [str(number) for number in range(len(rows))]:
        raise ValueError(f"expected a line for each of {setting.controllers} controllers")
    scores = np.array([[*_numbers(row, len(setting.bodies))] for row in rows])
    empty = {(int(row), int(column)) for row, column in np.argwhere(np.isnan(scores))}
    if empty != {(each.controller, each.body) for each in found.divergences()}:
        raise ValueError(f"empty cells differ from the diverged simulations in {SETTING_FILE}")
    return scores


def _numbers(row: list[str], bodies: int) -> Iterator[float]:
    if len(row) != bodies + 1:
        raise ValueError(f"controller {row[0]}: expected {bodies} scores, found {len(row) - 1}")
    for cell in row[1:]:
        if cell and not math.isfinite(float(cell)):
            raise ValueError(f"controller {row[0]}: expected a finite score, found {cell}")
        yield float(cell) if cell else math.nan
