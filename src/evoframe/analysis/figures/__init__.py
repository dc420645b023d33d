"""Figures for print: matplotlib figures of studies, runs, bodies and networks, to edit or save.

:func:`curves`, :func:`finals` and :func:`ranks` draw a view of a study, :func:`draw_lines` values over
generations, :func:`body` a design, and :func:`network` the network of a genome.
"""

import evoframe.analysis.drawing  # noqa: F401 - before others import matplotlib
from evoframe.analysis.figures.bodies import body
from evoframe.analysis.figures.lines import Line, lines_of_run, lines_of_view
from evoframe.analysis.figures.networks import TooLargeError, network
from evoframe.analysis.figures.studies import curves, curves_of, draw_lines, finals, ranks

__all__ = [
    "Line",
    "TooLargeError",
    "body",
    "curves",
    "curves_of",
    "draw_lines",
    "finals",
    "lines_of_run",
    "lines_of_view",
    "network",
    "ranks",
]
