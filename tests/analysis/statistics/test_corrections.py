"""Tests of the list of corrections: cheap to import, and supported by statsmodels."""

from __future__ import annotations

from typing import get_args

from processes import python
from statsmodels.stats.multitest import multipletests

from evoframe.analysis.statistics.corrections import CORRECTIONS, Correction

HEAVY = "matplotlib", "pandas", "plotly", "scikit_posthocs", "scipy", "statsmodels"


def test_importing_the_list_loads_no_statistics_library(tmp_path: object) -> None:
    program = (
        "import sys, evoframe.analysis.statistics.corrections;"
        f"print([name for name in {HEAVY} if name in sys.modules])"
    )
    assert python("-c", program).stdout.strip() == "[]"


def test_statsmodels_supports_each_correction_but_none() -> None:
    assert get_args(Correction) == CORRECTIONS
    for correction in CORRECTIONS:
        if correction != "none":
            assert multipletests([0.01, 0.02], method=correction)[1].max() >= 0.02
