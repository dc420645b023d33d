"""Reports of runs and studies: figures, tables, conclusions and the page, as files (:func:`report`)."""

from evoframe.analysis.report.api import report
from evoframe.record.run import Report

__all__ = ["Report", "report"]
