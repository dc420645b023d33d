"""Page that contains a whole report; displaying it requires no other file and no network."""

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
from evoframe.analysis.data.samples import Sample
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

_QUANTA = 32767  # displacements are stored as 16-bit integers
_NOTICEABLE = 0.15  # largest initial displacement after exaggeration, as a fraction of the body's extent
_MOST = 10.0  # largest exaggeration, as a multiple of the initial one
_STILL = 1e-9  # fraction of the extent; smaller displacements are rounding errors


@attrs.frozen
class Words:
    """A paragraph."""

    kind: ClassVar[str] = "words"
    text: str


@attrs.frozen
class Source:
    """The text of a file, collapsed until the reader opens it."""

    kind: ClassVar[str] = "source"
    caption: str
    text: str


@attrs.frozen
class Picture:
    """A matplotlib figure, as the bytes of an SVG file."""

    kind: ClassVar[str] = "picture"
    caption: str
    svg: bytes = attrs.field(repr=False)

    @property
    def base64(self) -> str:
        """The file as the payload of a data URL."""
        return base64.b64encode(self.svg).decode()


@attrs.frozen
class Chart:
    """A plotly figure.

    A trace with ``meta = {"color": n}`` is drawn in the n-th color of the page's light or dark theme. Traces
    with ``meta = {"label": text}`` are listed in a legend below the chart.
    """

    kind: ClassVar[str] = "chart"
    caption: str
    plot: Plot = attrs.field(repr=False)
    height: int = 360

    @property
    def json(self) -> str:
        """The figure as JSON, safe inside a ``script`` element."""
        return _in_script(self.plot.to_plotly_json())


@attrs.frozen
class Cell:
    """A table cell as displayed."""

    text: str
    is_number: bool


@attrs.frozen
class Table:
    """A table; integers are displayed in full, other numbers with four significant digits."""

    kind: ClassVar[str] = "table"
    caption: str
    frame: pd.DataFrame = attrs.field(repr=False)

    @property
    def columns(self) -> list[str]:
        """Names of the columns."""
        return [str(column) for column in self.frame.columns]

    @functools.cached_property
    def rows(self) -> list[list[Cell]]:
        """Cells of each row."""
        return [[_cell(value) for value in row] for row in self.frame.itertuples(index=False)]

    @property
    def numeric(self) -> list[bool]:
        """For each column: true if all its cells are numbers, which are aligned right."""
        return [all(row[column].is_number for row in self.rows) for column in range(len(self.columns))]


@attrs.frozen
class Motion:
    """A moving design.

    Attributes:
        caption: Text below it.
        geometry: The design at several times.
        track: Name of the point whose trace is drawn; ``None`` draws no trace.
        samples: Samples of the track that the objective compares; they are marked on the trace.
    """

    kind: ClassVar[str] = "motion"
    caption: str
    geometry: Geometry = attrs.field(repr=False)
    track: str | None = None
    samples: Sequence[Sample] = ()

    @property
    def compared(self) -> str:
        """A sentence with the displacement between two samples; empty unless there are two."""
        if self.track is None or len(self.samples) != 2:
            return ""
        first, last = self.samples
        moved = zip("xyz", first.position, last.position, strict=True)
        along = ", ".join(f"{axis} {1000 * (end - start):+.3f} mm" for axis, start, end in moved)
        return (
            f"The objective compares {first.name} ({first.time:.4f} s) with {last.name} ({last.time:.4f} s). "
            f"Between them, the {self.track} moves by {along}."
        )

    @property
    def json(self) -> str:
        """The motion as JSON, safe inside a ``script`` element."""
        return _in_script(_motion_document(self.geometry, self.track, self.samples))


Block: TypeAlias = Words | Source | Picture | Chart | Table | Motion


@attrs.frozen
class Section:
    """A part of a page, with a heading."""

    title: str
    blocks: Sequence[Block]


@attrs.frozen(eq=False)
class Part:
    """Sections and files that one subject adds to a report.

    Attributes:
        sections: Sections of the page.
        files: Files beside the page: name -> bytes.
    """

    sections: Sequence[Section] = ()
    files: Mapping[str, bytes] = attrs.field(factory=dict, repr=False)


def page(title: str, lead: str, sections: Sequence[Section], facts: Mapping[str, str] | None = None) -> bytes:
    """Return a page as the bytes of an HTML file.

    Args:
        title: Heading of the page.
        lead: Sentence below the heading.
        sections: Sections; empty tables, and sections that contain nothing else, are omitted.
        facts: Settings listed below the lead: label -> value.
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
        facts=facts or {},
        sections=list(zip(anchors, shown, strict=True)),
        version=__version__,
        style=_file("page.css"),
        scripts=scripts,
        hashes=[
            f"'sha256-{base64.b64encode(digest).decode()}'" for digest in digests
        ],  # of the only scripts that may run
    )
    return text.encode()


def _file(name: str) -> str:
    return (resources.files("evoframe.analysis.page") / "templates" / name).read_text(encoding="utf-8")


def _in_script(document: Mapping[str, Any]) -> str:
    """Return JSON that is safe inside a ``script`` element: it contains nothing that ends the element."""
    text = json.dumps(document, default=lambda array: array.tolist(), allow_nan=False, separators=(",", ":"))
    return text.replace("<", "\\u003c").replace("\u2028", "\\u2028").replace("\u2029", "\\u2029")


def _cell(value: Any) -> Cell:
    if isinstance(value, float | np.floating):
        return Cell("-" if math.isnan(value) else f"{value:.4g}", is_number=True)
    if isinstance(value, int | np.integer) and not isinstance(value, bool):
        return Cell(str(value), is_number=True)
    return Cell("-" if value is None else str(value), is_number=False)


def _motion_document(geometry: Geometry, track: str | None, samples: Sequence[Sample]) -> dict[str, Any]:
    moves = [part.vertices - part.vertices[0] for part in geometry.parts]
    points = None if track is None else geometry.tracks[track]
    largest = max(float(np.abs(moved).max()) for moved in moves)
    extent = max(float(np.ptp(part.vertices[0], axis=0).max()) for part in geometry.parts)
    if largest <= _STILL * extent:
        moves, largest = [np.zeros_like(moved) for moved in moves], 0.0
    exaggeration = _round(_NOTICEABLE * extent / largest) if largest else 1
    step = largest / _QUANTA or 1.0
    # For each axis: least and greatest coordinate at rest, least and greatest displacement.
    rest = np.concatenate([part.vertices[0] for part in geometry.parts])
    moved = np.concatenate([(part.vertices - part.vertices[0]).reshape(-1, 3) for part in geometry.parts])
    bounds = np.stack([rest.min(axis=0), rest.max(axis=0), moved.min(axis=0), moved.max(axis=0)], axis=1)
    return {
        "times": geometry.times,
        "step": step,
        "parts": [
            {
                "label": part.name,
                "name": escape(part.name, quote=False),  # plotly interprets some HTML
                "color": part.colour,
                "opacity": part.opacity,
                "faces": part.faces,
                "rest": _base64(part.vertices[0].astype("<f4")),
                "moves": _base64((moved / step).round().astype("<i2")),
            }
            for part, moved in zip(geometry.parts, moves, strict=True)
        ],
        "bounds": bounds,
        "track": None
        if points is None
        else {"label": track, "name": escape(str(track), quote=False), "positions": points},
        "samples": [attrs.asdict(sample) for sample in samples],
        "exaggeration": exaggeration,
        "most": max(10, int(_MOST * exaggeration)),
    }


def _round(value: float) -> int:
    """Return the largest of 1, 2 and 5 times a power of ten that does not exceed *value*; at least 1."""
    if value < 1.0:
        return 1
    power = 10 ** math.floor(math.log10(value))
    return int(max(factor * power for factor in (1, 2, 5) if factor * power <= value))


def _base64(array: NDArray[Any]) -> str:
    return base64.b64encode(np.ascontiguousarray(array).tobytes()).decode()
