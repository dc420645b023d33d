"""The page of a report: one HTML file that needs no other file and no network.

:func:`page` makes it of sections, whose blocks are words, tables, pictures, charts and a body that moves.
"""

from evoframe.analysis.page.charts import finals_chart, lines_chart
from evoframe.analysis.page.html import (
    Block,
    Chart,
    Motion,
    Part,
    Picture,
    Section,
    Source,
    Table,
    Words,
    page,
)

__all__ = [
    "Block",
    "Chart",
    "Motion",
    "Part",
    "Picture",
    "Section",
    "Source",
    "Table",
    "Words",
    "finals_chart",
    "lines_chart",
    "page",
]
