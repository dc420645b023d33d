"""Layout of networks in columns, from left to right.

The steps are those of Sugiyama, Tagawa and Toda (1981): a node is placed one column after the last node that
it depends on, a link that passes columns has its own track in each of them, and columns are sorted by
barycenters to reduce crossings. Existing libraries require the program Graphviz, or are under the GPL,
unlike this project.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from graphlib import CycleError, TopologicalSorter
from itertools import pairwise
from typing import TypeAlias

import attrs
import numpy as np
from numpy.typing import NDArray
from scipy.optimize import isotonic_regression

from evoframe.contract import NetworkGraph, NetworkLink

__all__ = ["Layout", "effective", "layered"]

_SWEEPS = 24
_TRACK = 0.4  # height of the track of a passing link, in rows
_PORT = 0.12  # distance of links at one side of a node, in rows
_PORTS = 0.45  # greatest height of all links at one side of a node, in rows
_STRAIGHT = 4.0  # weight of a track's height, relative to that of a node
_ALONE = 1e-3  # weight of the height of a node without links


@attrs.frozen
class Layout:
    """A layout in columns and rows; heights increase downwards.

    Attributes:
        columns: Node -> column; 0 is the leftmost.
        heights: Node -> height of its center, in rows.
        routes: For each link of the graph, its heights at its start, in each column that it passes, and at
            its end. A backward link, which closes a cycle, passes no columns.
        returns: True if there are backward links.
        rows: Height of the layout, in rows.
    """

    columns: Mapping[int, int]
    heights: Mapping[int, float]
    routes: tuple[tuple[float, ...], ...]
    returns: bool
    rows: float


@attrs.frozen(order=True)
class _Item:
    """An item of a column: a node, or the track of a link."""

    column: int
    id: int  # of the node, or the index of the link
    is_track: bool = False

    @property
    def half(self) -> float:
        return _TRACK / 2 if self.is_track else 0.5


Joined: TypeAlias = Mapping[_Item, Sequence[_Item]]


@attrs.frozen
class _Grid:
    """The items of all columns in order, and the items that each is linked to in the next column."""

    columns: list[list[_Item]]
    before: Joined
    after: Joined


def effective(graph: NetworkGraph) -> NetworkGraph:
    """Return *graph* without the nodes that no output depends on; inputs and outputs are kept."""
    before: dict[int, list[int]] = defaultdict(list)
    for link in graph.links:
        before[link.end].append(link.start)
    needed, waiting = set(graph.outputs), list(graph.outputs)
    while waiting:
        found = set(before[waiting.pop()]) - needed
        needed |= found
        waiting += found
    return attrs.evolve(
        graph,
        labels={node: label for node, label in graph.labels.items() if node in needed},
        links=tuple(link for link in graph.links if link.end in needed),
    )


def layered(graph: NetworkGraph) -> Layout:
    """Return the layout of *graph*, which is deterministic.

    Inputs are in the first column and outputs in the last, in their order. An output that other nodes depend
    on is placed before these.
    """
    columns = _columns(graph)
    paths = []
    for index, link in enumerate(graph.links):
        first, last = columns[link.start], columns[link.end]
        tracks = [_Item(column, index, is_track=True) for column in range(first + 1, last)]
        paths.append([_Item(first, link.start), *tracks, _Item(last, link.end)])
    grid = _ordered(_grid(graph, columns, paths))
    middles = _heights(grid)
    ends = _ports(graph.links, paths, middles)
    routes = tuple(
        (ends[index, True], *(middles[item] for item in path[1:-1]), ends[index, False])
        for index, path in enumerate(paths)
    )
    return Layout(
        columns=columns,
        heights={item.id: height for item, height in middles.items() if not item.is_track},
        routes=routes,
        returns=any(path[0].column >= path[-1].column for path in paths),
        rows=max(height + item.half for item, height in middles.items()),
    )


def _columns(graph: NetworkGraph) -> dict[int, int]:
    nodes = [*graph.inputs, *sorted(set(graph.labels) - set(graph.inputs))]
    order, links = _sorted(nodes, [link for link in graph.links if link.end not in graph.inputs])
    before, after = defaultdict(list), defaultdict(list)
    for link in links:
        before[link.end].append(link.start)
        after[link.start].append(link.end)
    columns = dict.fromkeys(graph.inputs, 0)
    for node in order:
        if node not in columns:
            columns[node] = 1 + max((columns[start] for start in before[node]), default=0)
    hidden = set(columns) - {*graph.inputs, *graph.outputs}
    for node in hidden:  # nodes without inputs are placed just before the first node that depends on them
        if not before[node] and after[node]:
            columns[node] = min(columns[end] for end in after[node]) - 1
    last = max([1, *(columns[node] for node in graph.outputs), *(1 + columns[node] for node in hidden)])
    return columns | {node: last for node in graph.outputs if not after[node]}


def _sorted(nodes: Iterable[int], links: Iterable[NetworkLink]) -> tuple[list[int], list[NetworkLink]]:
    """Return the nodes in topological order, and the links without those that close a cycle."""
    forward = [link for link in links if link.start != link.end]
    while True:
        sorter = TopologicalSorter(dict.fromkeys(nodes, ()))
        for link in forward:
            sorter.add(link.end, link.start)
        try:
            return list(sorter.static_order()), forward
        except CycleError as error:
            closing = tuple(error.args[1][-2:])
            forward = [link for link in forward if (link.start, link.end) != closing]


def _grid(graph: NetworkGraph, columns: Mapping[int, int], paths: Sequence[Sequence[_Item]]) -> _Grid:
    ranks = {node: rank for rank, node in enumerate((*graph.inputs, *graph.outputs))}
    nodes = sorted(columns, key=lambda node: (ranks.get(node, len(ranks)), node))
    items = [_Item(columns[node], node) for node in nodes]
    items += [item for path in paths for item in path[1:-1]]
    before, after = defaultdict(list), defaultdict(list)
    for one, other in (pair for path in paths for pair in pairwise(path)):
        if one.column < other.column:
            after[one].append(other)
            before[other].append(one)
    n_columns = 1 + max(columns.values())
    return _Grid([[i for i in items if i.column == column] for column in range(n_columns)], before, after)


def _ordered(grid: _Grid) -> _Grid:
    """Return the grid with the order of inner columns that has the fewest crossings in many sweeps."""
    best, fewest = grid, _crossings(grid)
    for sweep in range(_SWEEPS):
        if fewest == 0:
            break
        grid = _swept(grid, leftwards=bool(sweep % 2))
        crossings = _crossings(grid)
        if crossings < fewest:
            best, fewest = grid, crossings
    return best


def _swept(grid: _Grid, leftwards: bool) -> _Grid:
    """Return the grid with each inner column sorted by the mean positions of linked items on one side."""
    columns = [list(column) for column in grid.columns]
    places = _places(grid)
    joined = grid.after if leftwards else grid.before
    inner = range(1, len(columns) - 1)
    for number in reversed(inner) if leftwards else inner:
        means = {i: _mean([places[j] for j in joined.get(i, ())], places[i]) for i in columns[number]}
        columns[number].sort(key=means.__getitem__)
        places |= {item: float(place) for place, item in enumerate(columns[number])}
    return attrs.evolve(grid, columns=columns)


def _places(grid: _Grid) -> dict[_Item, float]:
    return {item: float(place) for column in grid.columns for place, item in enumerate(column)}


def _mean(values: Sequence[float], default: float) -> float:
    return sum(values) / len(values) if values else default


def _crossings(grid: _Grid) -> int:
    places = _places(grid)
    total = 0
    for column in grid.columns[:-1]:
        joins = np.array([(places[i], places[j]) for i in column for j in grid.after.get(i, ())])
        if len(joins):
            left, right = (np.subtract.outer(side, side) for side in joins.T)
            total += int((left * right < 0).sum()) // 2
    return total


def _heights(grid: _Grid) -> dict[_Item, float]:
    """Return the height of each item: close to its linked items, and without overlap in its column."""
    heights: dict[_Item, float] = {}
    for column in grid.columns:
        heights |= zip(column, (_stack(column) - _stack(column).mean()).tolist(), strict=True)
    for joined in [grid.before, grid.after] * 4 + [_both(grid)] * 4 + [_straightened(grid)] * 12:
        for column in reversed(grid.columns) if joined is grid.after else grid.columns:
            heights |= _placed(column, joined, heights, grid)
    top = min(height - item.half for item, height in heights.items())
    return {item: height - top for item, height in heights.items()}


def _both(grid: _Grid) -> Joined:
    return {i: [*grid.before.get(i, ()), *grid.after.get(i, ())] for column in grid.columns for i in column}


def _straightened(grid: _Grid) -> Joined:
    """Return the linked items of each item; for tracks, all tracks of their link, which keeps it straight."""
    tracks = defaultdict(list)
    for item in (item for column in grid.columns for item in column if item.is_track):
        tracks[item.id].append(item)
    return {i: tracks[i.id] if i.is_track else joined for i, joined in _both(grid).items()}


def _placed(
    column: Sequence[_Item], joined: Joined, heights: Mapping[_Item, float], grid: _Grid
) -> dict[_Item, float]:
    """Return the heights closest to those of linked items without overlap in the column."""
    wanted = {i: _mean([heights[j] for j in joined.get(i, ())], heights[i]) for i in column}
    alone = {i for i in column if i not in grid.before and i not in grid.after}
    middle = _mean([wanted[i] for i in column if i not in alone], 0.0)
    weights = [_ALONE if i in alone else _STRAIGHT if i.is_track else 1.0 for i in column]
    stack = _stack(column)
    targets = np.array([middle if i in alone else wanted[i] for i in column])
    found = stack + isotonic_regression(targets - stack, weights=weights).x
    return dict(zip(column, found.tolist(), strict=True))


def _stack(column: Sequence[_Item]) -> NDArray[np.float64]:
    """Return the heights of items that touch each other."""
    return np.cumsum([0.0, *(above.half + below.half for above, below in pairwise(column))])


def _ports(
    links: Sequence[NetworkLink], paths: Sequence[Sequence[_Item]], middles: Mapping[_Item, float]
) -> dict[tuple[int, bool], float]:
    """Return the heights of both ends of each link: (index of the link, True for its start) -> height.

    At each side of a node, links are sorted by the heights of their other ends.
    """
    sides: dict[tuple[int, bool], list[tuple[float, int]]] = defaultdict(list)
    for index, (link, path) in enumerate(zip(links, paths, strict=True)):
        sides[link.start, True].append((middles[path[1]], index))
        sides[link.end, False].append((middles[path[-2]], index))
    heights = {item.id: height for item, height in middles.items() if not item.is_track}
    ports = {}
    for (node, is_start), joined in sides.items():
        step = min(_PORT, _PORTS / len(joined))
        for number, (_, index) in enumerate(sorted(joined)):
            ports[index, is_start] = heights[node] + step * (number - (len(joined) - 1) / 2)
    return ports
