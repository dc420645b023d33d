"""Figures and tables as files; the same content gives the same bytes, without timestamps."""

from __future__ import annotations

import io
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from evoframe.analysis.drawing import Figure, default_style
from evoframe.analysis.output.latex import latex_table
from evoframe.errors import InputError
from evoframe.files import write_atomically

__all__ = ["figure_files", "prepare_directory", "table_files", "write_files"]

_FORMATS: dict[str, dict[str, Any]] = {
    "pdf": {"metadata": {"CreationDate": None, "Creator": None, "Producer": None}},
    "svg": {"metadata": {"Date": None, "Creator": None}},
    "png": {"metadata": {"Software": None}, "dpi": 300},
}


def prepare_directory(directory: Path) -> Path:
    """Create a directory for a report unless it exists, and check that it is writable.

    Raises:
        InputError: The directory cannot be created, or is not writable.
    """
    try:
        directory.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=directory):
            pass
    except OSError as error:
        raise InputError(f"cannot be used for a report: {error.strerror}", source=directory) from error
    return directory


def figure_files(figure: Figure, name: str) -> dict[str, bytes]:
    """Return a figure as PDF, SVG and PNG with the same layout: file name -> bytes.

    Args:
        figure: The figure.
        name: Name of the files without extension. The ids in the SVG file depend on it.
    """
    files = {}
    with default_style(**{"svg.hashsalt": name, "pdf.fonttype": 42, "svg.fonttype": "none"}):
        figure.draw_without_rendering()
        figure.set_layout_engine("none")  # otherwise each format gets a slightly different layout
        for ending, options in _FORMATS.items():
            data = io.BytesIO()
            figure.savefig(data, format=ending, **options)
            files[f"{name}.{ending}"] = data.getvalue()
    return files


def table_files(
    table: pd.DataFrame,
    name: str,
    article: pd.DataFrame | None = None,
    by: Sequence[str] = (),
    wrapped: str = "",
) -> dict[str, bytes]:
    """Return a table as CSV with all digits, and as LaTeX for one column of an article: file name -> bytes.

    Args:
        table: The table.
        name: Name of the files without extension.
        article: The table to print in LaTeX, if it has fewer columns or digits.
        by: As for :func:`latex_table`, as is *wrapped*.
        wrapped: Column of long texts.
    """
    latex = latex_table(table if article is None else article, by, wrapped)
    return {f"{name}.csv": table.to_csv(index=False).encode(), f"{name}.tex": latex.encode()}


def write_files(files: Mapping[str, bytes], directory: Path) -> list[Path]:
    """Write files into a directory, each atomically, and return their paths.

    Args:
        files: Name -> bytes.
        directory: An existing directory.

    Raises:
        RunError: A file cannot be written.
    """
    for name, data in files.items():
        write_atomically(directory / name, data)
    return [directory / name for name in files]
