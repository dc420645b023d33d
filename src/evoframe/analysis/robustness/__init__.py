"""What a measurement of robustness says: statistics, figure, words and files."""

from evoframe.analysis.robustness.files import as_json, records, write_findings, write_robustness
from evoframe.analysis.robustness.findings import Findings, find
from evoframe.analysis.robustness.section import RobustnessPart, robustness_part
from evoframe.analysis.robustness.tables import groups_table
from evoframe.analysis.robustness.violins import violins
from evoframe.analysis.robustness.words import conclusions
from evoframe.robustness.files import read_robustness

__all__ = [
    "Findings",
    "RobustnessPart",
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
