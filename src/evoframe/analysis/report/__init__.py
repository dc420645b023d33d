"""Reports of runs and studies: figures, tables, conclusions and an HTML page (:func:`report`)."""

import evoframe.analysis.drawing  # noqa: F401 - before others import matplotlib
from evoframe.analysis.report.api import report
from evoframe.record.run import Report

__all__ = ["Report", "report"]
