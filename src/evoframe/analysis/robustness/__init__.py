"""Findings of a measurement of robustness: statistics, tables, figure, conclusions and files.

:func:`find` compares the groups of a measurement; the other functions present the findings.
"""

import evoframe.analysis.drawing  # noqa: F401 - before others import matplotlib
from evoframe.analysis.robustness.figure import violins
from evoframe.analysis.robustness.files import as_json, records, write_findings, write_robustness
from evoframe.analysis.robustness.findings import Findings, find
from evoframe.analysis.robustness.section import robustness_part
from evoframe.analysis.robustness.tables import groups_table
from evoframe.analysis.robustness.words import conclusions
from evoframe.robustness.files import read_robustness

__all__ = [
    "Findings",
    "as_json",
    "conclusions",
    "find",
    "groups_table",
    "read_robustness",
    "records",
    "robustness_part",
    "violins",
    "write_findings",
    "write_robustness",
]
