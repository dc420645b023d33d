"""Figures and tables as files: the same content gives the same bytes, with nothing of the time in them."""

from __future__ import annotations

import io
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import attrs
import matplotlib as mpl
import pandas as pd
from matplotlib.figure import Figure

from evoframe.errors import InputError
from evoframe.files.writing import write_atomically

__all__ = [
    "Rendered",
    "Written",
    "prepare_directory",
    "rendered",
    "write_bytes",
    "write_figure",
    "write_table",
]

_FORMATS: dict[str, dict[str, Any]] = {
    "pdf": {"metadata": {"CreationDate": None, "Creator": None, "Producer": None}},
    "svg": {"metadata": {"Date": None, "Creator": None}},
    "png": {"metadata": {"Software": None}, "dpi": 300},
}

_SIGNS = str.maketrans({"<": r"\textless{}", ">": r"\textgreater{}"})  # others in LaTeX's usual fonts


@attrs.frozen
class Written:
    """A report.

    Attributes:
        words: What it says.
        files: What was written.
    """

    words: str
    files: tuple[Path, ...]


@attrs.frozen
class Rendered:
    """A figure as the files that it becomes.

    Attributes:
        name: What they are called, without an ending.
        files: Ending -> bytes.
    """

    name: str
    files: Mapping[str, bytes] = attrs.field(repr=False)

    @property
    def svg(self) -> bytes:
        """What stands in a page."""
        return self.files["svg"]

    def write(self, directory: Path) -> list[Path]:
        """Write the files, and return their paths.

        Raises:
            RunError: They cannot be written.
        """
        return [write_bytes(data, directory / f"{self.name}.{ending}") for ending, data in self.files.items()]


def prepare_directory(directory: Path) -> Path:
    """Make a directory for a report, if it is not there, and see that it can be written to.

    Raises:
        InputError: It cannot be made, or not be written to.
    """
    try:
        directory.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=directory):
            pass
    except OSError as error:
        raise InputError(f"{directory}: cannot be used for a report: {error.strerror}") from error
    return directory


def write_figure(figure: Figure, path: Path) -> list[Path]:
    """Write a figure as PDF, SVG and PNG.

    Args:
        figure: What is drawn.
        path: Where to, without an ending.

    Returns:
        What was written.

    Raises:
        RunError: It cannot be written.
    """
    return rendered(figure, path.name).write(path.parent)


def rendered(figure: Figure, name: str) -> Rendered:
    """Return a figure in all formats; it has the same layout in each.

    Args:
        figure: What is drawn.
        name: What its files are called, without an ending. It makes the ids in an SVG file its own.
    """
    figure.draw_without_rendering()
    figure.set_layout_engine("none")  # else it is arranged anew for each format, and slightly otherwise
    return Rendered(name, {ending: _bytes_of(figure, ending, name) for ending in _FORMATS})


def write_table(table: pd.DataFrame, path: Path) -> list[Path]:
    """Write a table as CSV, and as LaTeX (package booktabs) with four digits.

    Args:
        table: What is written.
        path: Where to, without an ending.

    Returns:
        What was written.

    Raises:
        RunError: It cannot be written.
    """
    texts = {
        "csv": table.to_csv(index=False),
        "tex": table.to_latex(index=False, na_rep="-", float_format="%.4g", escape=True).translate(_SIGNS),
    }
    return [
        write_bytes(text.encode(), path.with_name(f"{path.name}.{ending}")) for ending, text in texts.items()
    ]


def write_bytes(data: bytes, path: Path) -> Path:
    """Write a file, and return its path.

    Raises:
        RunError: It cannot be written.
    """
    write_atomically(path, data)
    return path


def _bytes_of(figure: Figure, ending: str, name: str) -> bytes:
    data = io.BytesIO()
    with mpl.rc_context({"svg.hashsalt": name, "pdf.fonttype": 42, "svg.fonttype": "none"}):
        figure.savefig(data, format=ending, **_FORMATS[ending])
    return data.getvalue()
