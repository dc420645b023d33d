"""What a measurement of robustness says: statistics, figure, words and files."""

from evoframe.analysis.robustness.files import (
    SETTING_FILE,
    as_json,
    read_robustness,
    refuse_another,
    write_robustness,
)
from evoframe.analysis.robustness.findings import Findings, find
from evoframe.analysis.robustness.section import robustness_report
from evoframe.analysis.robustness.violins import violins
from evoframe.analysis.robustness.words import conclusions

__all__ = [
    "SETTING_FILE",
    "Findings",
    "as_json",
    "conclusions",
    "find",
    "read_robustness",
    "refuse_another",
    "robustness_report",
    "violins",
    "write_robustness",
]
