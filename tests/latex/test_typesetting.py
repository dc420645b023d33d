"""Tables of reports are typeset by pdflatex, and fit into a column."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pandas as pd
import pytest

from evoframe.analysis.output.latex import latex_table

PAIRS = pd.DataFrame({"heading": ["one", "two"], "name": ["a > b " * 30, "50% |c|"], "p": ["< 0.001", "-"]})


@pytest.mark.latex
def test_tables_compile_in_one_column(tmp_path: Path) -> None:
    wide = pd.DataFrame({f"a long title {n}": [1.0, 2.0] for n in range(20)})
    long = pd.DataFrame({"heading": ["x"] * 120, "name": [f"$ & # _ {n}" for n in range(120)]})
    for name, latex in (
        ("wide", latex_table(wide)),
        ("long", latex_table(long, by=["heading"])),
        ("wrapped", latex_table(PAIRS, by=["heading"], wrapped="name")),
        ("empty", latex_table(PAIRS[:0])),
    ):
        (tmp_path / f"{name}.tex").write_text(latex)
    (tmp_path / "all.tex").write_text(
        r"\documentclass[twocolumn]{article}\usepackage{array,booktabs,graphicx}\begin{document}"
        r"\begin{table}\centering\input{wide}\caption{x}\end{table}\input{long}\input{wrapped}\input{empty}"
        r"\end{document}"
    )
    pdflatex = shutil.which("pdflatex")
    assert pdflatex
    made = subprocess.run(
        [pdflatex, "-interaction=nonstopmode", "-halt-on-error", "all.tex"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        errors="replace",
        check=False,
    )
    assert made.returncode == 0, made.stdout
    assert "Overfull" not in made.stdout
