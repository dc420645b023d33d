"""Figures of networks for print: inputs at the left, outputs at the right."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import attrs
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import FancyArrowPatch, FancyBboxPatch
from matplotlib.path import Path

from evoframe.analysis.drawing import Figure
from evoframe.analysis.figures.layered import Layout, effective, layered
from evoframe.analysis.figures.plain import plain
from evoframe.analysis.figures.printed import BOTH_COLUMNS, COLOURS, COLUMN, text_width
from evoframe.contract import NetworkGraph, NetworkLink

__all__ = ["TooLargeError", "network"]

POSITIVE, NEGATIVE = COLOURS[:2]
INK, GREY, PALE = "#202020", "#606060", "#B0B0B0"
DASHES = (0, (4, 1.5))

# In inches, except for font sizes and line widths, which are in points.
_WIDTHS = {COLUMN: 0.3, BOTH_COLUMNS: 0.18}  # width of the figure -> smallest gap between columns of nodes
_ROW, _LINE, _PAD, _MARGIN = 0.31, 0.1, 0.05, 0.05
_LANE = 0.3  # above the network, for backward links
_TITLE, _NOTE, _LEGEND = 0.17, 0.13, 0.16  # heights of lines of text
_SIZE = 6.5
_THINNEST, _THICKEST = 0.5, 2.2
_LONGEST = 8  # characters of a label on one line
_MOST = 500  # nodes and links; larger figures take seconds and are not readable


class TooLargeError(ValueError):
    """A network with too many nodes and links for a readable figure."""


@plain
def network(
    graph: NetworkGraph, input_names: Sequence[str], output_names: Sequence[str], title: str = ""
) -> Figure:
    """Draw *graph*: boxes with the names of activations, and links as wide as their weights.

    Positive weights are solid blue lines, negative ones dashed vermilion lines. Nodes that no output depends
    on are omitted, and counted below the title; inputs that no output depends on are pale. A backward link,
    which closes a cycle, is an arrow. The figure is as wide as one column of an article (3.5 inches) or two
    (7 inches); the figure of a wider network has to be scaled down.

    Args:
        graph: The network.
        input_names: A name for each input; if empty, inputs are numbered.
        output_names: A name for each output; if empty, outputs are numbered.
        title: Title of the figure.

    Raises:
        TooLargeError: The network has more than 500 nodes and links.
        ValueError: The number of names differs from the number of inputs or outputs.
    """
    input_names = _names("input", graph.inputs, input_names)
    output_names = _names("output", graph.outputs, output_names)
    drawn = effective(graph)
    if len(drawn.labels) + len(drawn.links) > _MOST:
        raise TooLargeError(
            f"{len(drawn.labels)} nodes and {len(drawn.links)} links exceed the {_MOST} of a readable figure"
        )
    layout = layered(drawn)
    labels = {**dict(sorted(drawn.labels.items())), **dict(zip(graph.inputs, input_names, strict=True))}
    wrapped = {node: _wrapped(label) for node, label in labels.items()}
    sheet = _sheet(layout, wrapped, output_names)
    hidden, shown = (len(set(g.labels) - {*g.inputs, *g.outputs}) for g in (graph, drawn))
    rest = "has no effect and is" if hidden - shown == 1 else "have no effect and are"
    note = f"{hidden - shown} of {hidden} hidden nodes {rest} omitted" if hidden > shown else ""
    title_lines = textwrap.wrap(title, int(13 * sheet.width))
    figure, axes = _figure(sheet, title_lines, note, _legend(drawn.links))
    drawing = _Drawing(axes, sheet, drawn, layout, wrapped)
    drawing.nodes()
    drawing.links()
    drawing.names(output_names)
    return figure


def _names(what: str, nodes: Sequence[int], names: Sequence[str]) -> Sequence[str]:
    if not names:
        return [f"{what} {number}" for number, _ in enumerate(nodes, start=1)]
    if len(names) != len(nodes):
        raise ValueError(
            f"{len(names)} names for {len(nodes)} {what}s ({', '.join(names)}), expected one each"
        )
    return names


@attrs.frozen
class _Sheet:
    """Positions on paper, in inches from the upper left corner of the network.

    Attributes:
        width: Width of the figure.
        top: Upper edge of the drawing; negative if there are backward links.
        bottom: Lower edge of the drawing.
        columns: Left and right edge of each column.
    """

    width: float
    top: float
    bottom: float
    columns: Sequence[tuple[float, float]]


@attrs.frozen
class _Drawing:
    """A network being drawn."""

    axes: Axes
    sheet: _Sheet
    graph: NetworkGraph
    layout: Layout
    labels: Mapping[int, str]

    def nodes(self) -> None:
        """Draw a box for each node, with its label."""
        used = {link.start for link in self.graph.links}
        for node, label in self.labels.items():
            is_input = node in self.graph.inputs
            colour = PALE if is_input and node not in used else INK
            left, right = self._edges(node)
            middle, height = self._middle(node), _LINE * (1 + label.count("\n")) + 0.08
            self.axes.add_patch(
                FancyBboxPatch(
                    (left, middle - height / 2),
                    right - left,
                    height,
                    boxstyle="square,pad=0" if is_input else "round,pad=0,rounding_size=0.07",
                    facecolor="#F2F2F2" if is_input else "white",
                    edgecolor=colour,
                    lw=1.2 if node in self.graph.outputs else 0.6,
                    zorder=2,
                )
            )
            self._write((left + right) / 2, middle, label, color=colour, ha="center")

    def links(self) -> None:
        """Draw each link; links of large weight are below the others."""
        largest = max((abs(link.weight) for link in self.graph.links), default=1.0)
        pairs = zip(self.graph.links, self.layout.routes, strict=True)
        for link, route in sorted(pairs, key=lambda pair: -abs(pair[0].weight)):
            returns = self.layout.columns[link.start] >= self.layout.columns[link.end]
            self.axes.add_patch(
                FancyArrowPatch(
                    path=self._return(link, route) if returns else self._path(link, route),
                    arrowstyle="-|>" if returns else "-",
                    mutation_scale=6,
                    facecolor=_color(link.weight) if returns else "none",
                    edgecolor=_color(link.weight),
                    linestyle=DASHES if link.weight < 0 else "-",
                    lw=_width(link.weight, largest),
                    zorder=1,
                    clip_on=False,
                )
            )

    def names(self, output_names: Iterable[str]) -> None:
        """Write the name of each output to its right, or below it if links continue to the right."""
        last = len(self.sheet.columns) - 1
        for node, name in zip(self.graph.outputs, output_names, strict=True):
            left, right = self._edges(node)
            if self.layout.columns[node] == last:
                self._write(right + _PAD, self._middle(node), name, ha="left", weight="bold")
            else:
                self._write((left + right) / 2, self._middle(node) + 0.17, name, ha="center", weight="bold")

    def _edges(self, node: int) -> tuple[float, float]:
        """Return the left and right edge of a node's box."""
        left, right = self.sheet.columns[self.layout.columns[node]]
        half = _box_width(self.labels[node]) / 2
        return (left + right) / 2 - half, (left + right) / 2 + half

    def _middle(self, node: int) -> float:
        return self.layout.heights[node] * _ROW

    def _path(self, link: NetworkLink, route: Sequence[float]) -> Path:
        """Return a curve that changes its height only between columns, where there are no nodes."""
        first, y = self.layout.columns[link.start], route[0] * _ROW
        vertices, codes = [(self._edges(link.start)[1], y)], [Path.MOVETO]
        for column, height in enumerate(route[1:], start=first):
            right, left = self.sheet.columns[column][1], self.sheet.columns[column + 1][0]
            middle, below = (right + left) / 2, height * _ROW
            vertices += [(right, y), (middle, y), (middle, below), (left, below)]
            codes += [Path.LINETO, Path.CURVE4, Path.CURVE4, Path.CURVE4]
            y = below
        return Path([*vertices, (self._edges(link.end)[0], y)], [*codes, Path.LINETO])

    def _return(self, link: NetworkLink, route: Sequence[float]) -> Path:
        """Return a curve from the right of a node, above the network, to the left of another."""
        right, left = self._edges(link.start)[1], self._edges(link.end)[0] - 0.01
        above = [(right + _LANE, self.sheet.top), (left - _LANE, self.sheet.top)]
        codes = [Path.MOVETO, *[Path.CURVE4] * 3]
        return Path([(right, route[0] * _ROW), *above, (left, route[-1] * _ROW)], codes)

    def _write(self, x: float, y: float, words: str, **style: Any) -> None:
        self.axes.text(
            x,
            y,
            words,
            size=_SIZE,
            va="center_baseline",
            linespacing=1.0,
            zorder=3,
            **style,
        )


def _color(weight: float) -> str:
    return NEGATIVE if weight < 0 else POSITIVE


def _width(weight: float, largest: float) -> float:
    return _THINNEST + (_THICKEST - _THINNEST) * (abs(weight) / largest if largest else 0.0)


def _wrapped(label: str) -> str:
    """Return a label on at most two lines, broken at blanks and after underscores."""
    lines, width = [label], _LONGEST + 2
    while len(label) > _LONGEST and len(lines := textwrap.wrap(label.replace("_", "_ "), width)) > 2:
        width += 1
    return "\n".join(line.replace("_ ", "_") for line in lines)


def _text_width(text: str) -> float:
    return text_width(text, _SIZE, "bold")  # the widest style in use


def _box_width(label: str) -> float:
    return max(2 * _LINE, _text_width(label) + 2 * _PAD)


def _sheet(layout: Layout, labels: Mapping[int, str], output_names: Iterable[str]) -> _Sheet:
    widths = [0.0] * (1 + max(layout.columns.values()))
    for node, column in layout.columns.items():
        widths[column] = max(widths[column], _box_width(labels[node]))
    needed = sum(widths) + max(map(_text_width, output_names)) + _PAD + 2 * _MARGIN
    gaps = len(widths) - 1
    fitting = (width for width, gap in _WIDTHS.items() if width >= needed + gap * gaps)
    width = next(fitting, needed + min(_WIDTHS.values()) * gaps)
    gap = (width - needed) / gaps
    lefts = [_MARGIN + sum(widths[:number]) + gap * number for number in range(len(widths))]
    columns = [(left, left + column) for left, column in zip(lefts, widths, strict=True)]
    return _Sheet(width, -_LANE if layout.returns else 0.0, layout.rows * _ROW, columns)


def _figure(sheet: _Sheet, title: Sequence[str], note: str, legend: Sequence[Line2D]) -> tuple[Figure, Axes]:
    """Return a figure with texts above and below axes in inches, which increase downwards."""
    n_columns = 2 if sheet.width == min(_WIDTHS) else 4
    above = _MARGIN + _TITLE * len(title) + _NOTE * bool(note) + _MARGIN
    below = _MARGIN + _LEGEND * -(-len(legend) // n_columns) + _MARGIN
    height = above + sheet.bottom - sheet.top + below
    figure = Figure(figsize=(sheet.width, height))
    axes = figure.add_axes((0, below / height, 1, (sheet.bottom - sheet.top) / height), frameon=False)
    axes.set(xlim=(0, sheet.width), ylim=(sheet.bottom, sheet.top), xticks=[], yticks=[])
    axes.set_title("\n".join(title), size=9, pad=72 * (_MARGIN + _NOTE * bool(note)))
    figure.text(0.5, (height - above + _MARGIN) / height, note, ha="center", size=7, color=GREY)
    if legend:
        figure.legend(handles=legend, loc="lower center", ncols=n_columns, frameon=False, fontsize=7)
    return figure, axes


def _legend(links: Iterable[NetworkLink]) -> list[Line2D]:
    """Return legend entries of the signs that occur, and of the smallest and largest weight."""
    weights = sorted((link.weight for link in links), key=abs)
    signs = [Line2D([], [], color=POSITIVE, lw=1.2, label="positive weight")] * any(w >= 0 for w in weights)
    if any(w < 0 for w in weights):
        signs.append(Line2D([], [], color=NEGATIVE, lw=1.2, linestyle=DASHES, label="negative weight"))
    sizes = {f"|weight| = {abs(w):.2g}": _width(w, abs(weights[-1])) for w in (*weights[:1], *weights[-1:])}
    return signs + [Line2D([], [], color=GREY, lw=lw, label=label) for label, lw in sizes.items()]
