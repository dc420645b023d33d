"""Output: figures and tables as files, their names, the list of a report's files, and texts from templates.

The same content always gives the same bytes. All sentences of conclusions are in the folder ``templates``.
"""

import evoframe.analysis.drawing  # noqa: F401 - before others import matplotlib
from evoframe.analysis.output.listing import LIST_FILE, listed, settle
from evoframe.analysis.output.names import slugs
from evoframe.analysis.output.texts import counted, written
from evoframe.analysis.output.writing import figure_files, prepare_directory, table_files, write_files

__all__ = [
    "LIST_FILE",
    "counted",
    "figure_files",
    "listed",
    "prepare_directory",
    "settle",
    "slugs",
    "table_files",
    "write_files",
    "written",
]
