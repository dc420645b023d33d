"""Files of a measurement: its figure, tables and conclusions, written next to its scores."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pandas as pd

from evoframe.analysis.data.units import in_unit
from evoframe.analysis.output.writing import figure_files, prepare_directory, table_files, write_files
from evoframe.analysis.robustness.figure import violins
from evoframe.analysis.robustness.findings import Findings
from evoframe.analysis.robustness.tables import (
    SCORES,
    bodies_article,
    bodies_table,
    groups_article,
    groups_table,
    pairs_article,
    pairs_table,
    ranking_article,
    ranking_table,
)
from evoframe.analysis.robustness.words import conclusions
from evoframe.robustness import document_of, refuse_another, write_measurement

__all__ = ["as_json", "records", "write_findings", "write_robustness"]


def write_robustness(found: Findings, directory: str | Path, *, force: bool = False) -> list[Path]:
    """Write a measurement, its figure, tables and conclusions.

    Args:
        found: The measurement and its tests.
        directory: Directory of the files: missing, empty, or with a measurement of the same setting, which is
            renewed.
        force: Whether to overwrite a measurement with another setting.

    Returns:
        The paths of the files.

    Raises:
        InputError: The directory contains something else, cannot be created, or is not writable.
        RunError: A file cannot be written.
    """
    refuse_another(Path(directory), found.measured.setting, force=force)
    directory = prepare_directory(Path(directory))
    return [*write_measurement(found.measured, directory), *write_findings(found, directory)]


def write_findings(found: Findings, directory: Path) -> list[Path]:
    """Write the figure, tables and conclusions of a measurement, but not its scores.

    Returns:
        The paths of the files.

    Raises:
        RunError: A file cannot be written.
    """
    files = {"conclusions.txt": conclusions(found).encode()}
    unit = found.measured.setting.unit
    tables = _all_tables(found)
    for name in ("groups", "bodies"):
        tables[name] = in_unit(tables[name], SCORES, unit)
    articles = {
        "groups": groups_article(found),
        "bodies": bodies_article(found.measured),
        "pairs": pairs_article(found),
        "ranking": ranking_article(found),
    }
    for name, table in tables.items():
        files |= table_files(table, name, articles[name], wrapped="ranking")
    return write_files(files | figure_files(violins(found.measured), "violins"), directory)


def as_json(found: Findings) -> dict[str, Any]:
    """Return a measurement, all its scores, tables and conclusions as JSON values."""
    rows = found.measured.scores.tolist()
    return {
        **document_of(found.measured),
        "scores": [[None if math.isnan(score) else score for score in row] for row in rows],
        "tables": {name: records(table) for name, table in _all_tables(found).items()},
        "conclusions": conclusions(found),
    }


def _all_tables(found: Findings) -> dict[str, pd.DataFrame]:
    return {
        "groups": groups_table(found),
        "bodies": bodies_table(found.measured),
        "pairs": pairs_table(found),
        "ranking": ranking_table(found),
    }


def records(table: pd.DataFrame) -> list[dict[str, Any]]:
    """Return the lines of a table as JSON values; missing values become ``None``."""
    lines = table.astype(object).to_dict(orient="records")
    return [{key: None if pd.isna(value) else value for key, value in line.items()} for line in lines]
