"""Tests of figures and tables as files: reproducible bytes, names and directories."""

from __future__ import annotations

from pathlib import Path

import pandas as pd
import pytest

from evoframe.analysis.drawing import Figure
from evoframe.analysis.output.writing import figure_files, prepare_directory, table_files, write_files
from evoframe.errors import InputError


def figure() -> Figure:
    """Return a figure with a constrained layout."""
    made = Figure(figsize=(2, 1), layout="constrained")
    made.add_subplot().plot([0, 1], [1, 0])
    return made


def test_a_figure_has_reproducible_bytes_and_ids_of_its_own() -> None:
    files = figure_files(figure(), "a")
    assert files == figure_files(figure(), "a")
    assert [*files] == ["a.pdf", "a.svg", "a.png"]
    assert files["a.pdf"].startswith(b"%PDF")
    assert files["a.png"].startswith(b"\x89PNG")
    assert figure_files(figure(), "b")["b.svg"] != files["a.svg"]  # one page may contain both


def test_a_table_is_exact_for_programs_and_short_for_people() -> None:
    files = table_files(pd.DataFrame({"ranking": ["A > B"], "p": [0.123456789], "none": [None]}), "t")
    assert files["t.csv"] == b"ranking,p,none\nA > B,0.123456789,\n"
    assert rb"A \textgreater{} B & 0.1235 & - \\" in files["t.tex"]
    short = table_files(pd.DataFrame({"p": [0.123456789]}), "t", pd.DataFrame({"p": ["0.12"]}))
    assert short["t.csv"] == b"p\n0.123456789\n"
    assert b"0.12 \\\\" in short["t.tex"]


def test_files_are_written_under_their_names(tmp_path: Path) -> None:
    there = prepare_directory(tmp_path / "a" / "b")
    assert write_files({"x": b"1", "y": b"2"}, there) == [there / "x", there / "y"]
    assert {path.name: path.read_bytes() for path in there.iterdir()} == {"x": b"1", "y": b"2"}


def test_a_directory_that_cannot_be_created_is_named(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(InputError, match="Not a directory") as caught:
        prepare_directory(tmp_path / "file" / "r")
    assert caught.value.source == str(tmp_path / "file" / "r")
