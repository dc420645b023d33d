"""Figures and tables as files: the same of them give the same bytes."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import matplotlib as mpl
import pandas as pd
from matplotlib.figure import Figure

from evoframe.errors import InputError
from evoframe.store import write_atomically

__all__ = ["prepare_directory", "write_figure", "write_table"]

# Nothing of the time or the program.
_FORMATS: dict[str, dict[str, Any]] = {
    "pdf": {"metadata": {"CreationDate": None, "Creator": None, "Producer": None}},
    "svg": {"metadata": {"Date": None, "Creator": None}},
    "png": {"metadata": {"Software": None}, "dpi": 300},
}


def prepare_directory(directory: Path) -> None:
    """Make a directory for a report, if there is none.

    Raises:
        InputError: It cannot be made.
    """
    try:
        directory.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"{directory}: cannot be used for a report: {error.strerror}") from error


def write_figure(figure: Figure, path: Path) -> list[Path]:
    """Write a figure as PDF, SVG and PNG, and return the paths: *path* with an ending each.

    Raises:
        RunError: It cannot be written.
    """
    written = []
    with mpl.rc_context({"svg.hashsalt": path.name, "pdf.fonttype": 42, "svg.fonttype": "none"}):
        for ending, options in _FORMATS.items():
            data = io.BytesIO()
            figure.savefig(data, format=ending, **options)
            target = path.with_name(f"{path.name}.{ending}")
            write_atomically(target, data.getvalue())
            written.append(target)
    return written


def write_table(table: pd.DataFrame, path: Path) -> list[Path]:
    """Write a table as CSV and LaTeX, and return the paths: *path* with an ending each.

    Raises:
        RunError: It cannot be written.
    """
    texts = {
        "csv": table.to_csv(index=False),
        "tex": table.to_latex(index=False, float_format="%.4g", escape=True),
    }
    written = []
    for ending, text in texts.items():
        target = path.with_name(f"{path.name}.{ending}")
        write_atomically(target, text.encode())
        written.append(target)
    return written
