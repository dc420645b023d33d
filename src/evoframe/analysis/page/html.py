"""One page that holds all of a report: no other file and no network is needed to look at it."""

from __future__ import annotations

import base64
import functools
import hashlib
import json
import math
from collections.abc import Mapping, Sequence
from html import escape
from importlib import resources
from typing import Any, ClassVar, TypeAlias

import attrs
import jinja2
import numpy as np
import pandas as pd
from numpy.typing import NDArray
from plotly.graph_objects import Figure as Plot
from plotly.offline import get_plotlyjs

from evoframe._version import __version__
from evoframe.analysis.output.names import slugs
from evoframe.contract import Geometry

__all__ = [
    "Block",
    "Cell",
    "Chart",
    "Motion",
    "Part",
    "Picture",
    "Section",
    "Source",
    "Table",
    "Words",
    "page",
]

_QUANTA = 32767  # displacements are told as 16-bit numbers
_NOTICEABLE = 0.15  # of the body's extent: how far the exaggeration moves it at first
_MOST = 10.0  # times that
_STILL = 1e-9  # of the extent: smaller displacements are rounding, and no motion


@attrs.frozen
class Words:
    """A paragraph."""

    kind: ClassVar[str] = "words"
    text: str


@attrs.frozen
class Source:
    """A text as it stands in a file, folded away."""

    kind: ClassVar[str] = "source"
    caption: str
    text: str


@attrs.frozen
class Picture:
    """A figure of matplotlib, as the bytes of an SVG file."""

    kind: ClassVar[str] = "picture"
    caption: str
    svg: bytes = attrs.field(repr=False)

    @property
    def base64(self) -> str:
        """The file as it stands in an address."""
        return base64.b64encode(self.svg).decode()


@attrs.frozen
class Chart:
    """A figure of plotly.

    A trace with ``meta = {"colour": n}`` gets the n-th colour of the page, light or dark.
    """

    kind: ClassVar[str] = "chart"
    caption: str
    plot: Plot = attrs.field(repr=False)
    height: int = 360

    @property
    def json(self) -> str:
        """The figure as it stands in the page."""
        return _in_script(self.plot.to_plotly_json())


@attrs.frozen
class Cell:
    """A cell of a table, as it is shown."""

    text: str
    is_number: bool


@attrs.frozen
class Table:
    """A table; numbers are shown with four digits."""

    kind: ClassVar[str] = "table"
    caption: str
    frame: pd.DataFrame = attrs.field(repr=False)

    @property
    def columns(self) -> list[str]:
        """The names of its columns."""
        return [str(column) for column in self.frame.columns]

    @functools.cached_property
    def rows(self) -> list[list[Cell]]:
        """Its cells."""
        return [[_cell(value) for value in row] for row in self.frame.itertuples(index=False)]

    @property
    def numeric(self) -> list[bool]:
        """Whether each column has numbers, which a reader compares from the right."""
        return [all(row[column].is_number for row in self.rows) for column in range(len(self.columns))]


@attrs.frozen
class Motion:
    """A design that moves.

    Attributes:
        caption: What stands below it.
        geometry: The design at several times.
        track: The name of the point whose trace is drawn; ``None`` draws none.
    """

    kind: ClassVar[str] = "motion"
    caption: str
    geometry: Geometry = attrs.field(repr=False)
    track: str | None = None

    @property
    def json(self) -> str:
        """The motion as it stands in the page."""
        return _in_script(_moving(self.geometry, self.track))


Block: TypeAlias = Words | Source | Picture | Chart | Table | Motion


@attrs.frozen
class Section:
    """A part of a page with a heading."""

    title: str
    blocks: Sequence[Block]


@attrs.frozen(eq=False)
class Part:
    """What a report has of one thing.

    Attributes:
        sections: Of the page.
        files: Name -> bytes, beside the page.
    """

    sections: Sequence[Section] = ()
    files: Mapping[str, bytes] = attrs.field(factory=dict, repr=False)


def page(title: str, lead: str, sections: Sequence[Section]) -> bytes:
    """Return a page as the bytes of an HTML file.

    Args:
        title: Its heading.
        lead: A sentence below it.
        sections: What it shows; empty tables, and sections without anything else, are left out.
    """
    full = [
        Section(section.title, [b for b in section.blocks if not isinstance(b, Table) or len(b.frame)])
        for section in sections
    ]
    shown = [section for section in full if section.blocks]
    anchors = slugs(section.title.lower() for section in shown)
    environment = jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True)
    template = environment.from_string(_file("page.html"))
    scripts = [get_plotlyjs(), _file("page.js")]
    digests = [hashlib.sha256(script.encode()).digest() for script in scripts]
    text = template.render(
        title=title,
        lead=lead,
        sections=list(zip(anchors, shown, strict=True)),
        version=__version__,
        style=_file("page.css"),
        scripts=scripts,
        hashes=[f"'sha256-{base64.b64encode(digest).decode()}'" for digest in digests],  # no other may run
    )
    return text.encode()


def _file(name: str) -> str:
    return (resources.files("evoframe.analysis.page") / "templates" / name).read_text(encoding="utf-8")


def _in_script(document: Mapping[str, Any]) -> str:
    """Return JSON that may stand in an element ``script``: nothing in it ends the element."""
    text = json.dumps(document, default=lambda array: array.tolist(), allow_nan=False, separators=(",", ":"))
    return text.replace("<", "\\u003c").replace("\u2028", "\\u2028").replace("\u2029", "\\u2029")


def _cell(value: Any) -> Cell:
    if isinstance(value, float | np.floating):
        return Cell("-" if math.isnan(value) else f"{value:.4g}", is_number=True)
    if value is None:
        return Cell("-", is_number=False)
    return Cell(str(value), is_number=isinstance(value, int | np.integer) and not isinstance(value, bool))


def _moving(geometry: Geometry, track: str | None) -> dict[str, Any]:
    moves = [part.vertices - part.vertices[0] for part in geometry.parts]
    points = None if track is None else geometry.tracks[track]
    largest = max(float(np.abs(moved).max()) for moved in moves)
    extent = max(float(np.ptp(part.vertices[0], axis=0).max()) for part in geometry.parts)
    if largest <= _STILL * extent:
        moves, largest = [np.zeros_like(moved) for moved in moves], 0.0
    exaggeration = _round(_NOTICEABLE * extent / largest) if largest else 1
    step = largest / _QUANTA or 1.0
    # For each axis where the body is at rest, and how far it moves down and up from there.
    rest = np.concatenate([part.vertices[0] for part in geometry.parts])
    moved = np.concatenate([(part.vertices - part.vertices[0]).reshape(-1, 3) for part in geometry.parts])
    bounds = np.stack([rest.min(axis=0), rest.max(axis=0), moved.min(axis=0), moved.max(axis=0)], axis=1)
    return {
        "times": geometry.times,
        "step": step,
        "parts": [
            {
                "name": escape(part.name, quote=False),  # plotly reads some HTML
                "colour": part.colour,
                "opacity": part.opacity,
                "faces": part.faces,
                "rest": _base64(part.vertices[0].astype("<f4")),
                "moves": _base64((moved / step).round().astype("<i2")),
            }
            for part, moved in zip(geometry.parts, moves, strict=True)
        ],
        "bounds": bounds,
        "track": None if points is None else {"name": escape(str(track), quote=False), "positions": points},
        "exaggeration": exaggeration,
        "most": max(10, int(_MOST * exaggeration)),
    }


def _round(value: float) -> int:
    """Return 1, 2 or 5 times a power of ten, the last that is not above *value*, but at least 1."""
    if value < 1.0:
        return 1
    power = 10 ** math.floor(math.log10(value))
    return int(max(factor * power for factor in (1, 2, 5) if factor * power <= value))


def _base64(array: NDArray[Any]) -> str:
    return base64.b64encode(np.ascontiguousarray(array).tobytes()).decode()
