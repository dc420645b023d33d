"""Page of a report: one HTML file that requires no other file and no network.

:func:`page` builds it from sections. Their blocks are paragraphs, tables, pictures, charts and a moving body.
"""

import evoframe.analysis.drawing  # noqa: F401 - before others import matplotlib
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
