"""What stands in a page."""

from __future__ import annotations

import base64
import hashlib
import json
import re
from html import unescape
from typing import Any

import attrs
import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings, strategies as st
from plotly.graph_objects import Figure, Scatter

from evoframe import Geometry, GeometryPart
from evoframe.analysis.page.html import (
    Block,
    Cell,
    Chart,
    Motion,
    Picture,
    Section,
    Source,
    Table,
    Words,
    page,
)

SQUARE = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], np.float64)
FACES = np.array([[0, 1, 2, 3]])


def moving(*heights: float, opacity: float = 1.0) -> Geometry:
    """A square of 1 m that is lifted."""
    vertices = np.array([SQUARE + np.array([0, 0, height]) for height in heights])
    part = GeometryPart("square", "#CC3311", opacity, vertices, FACES)
    return Geometry(np.arange(float(len(heights))), (part,), {"tip": vertices[:, 2]})


def told(motion: Motion) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(motion.json)
    return found


def decoded(text: str, kind: str) -> list[float]:
    numbers: list[float] = np.frombuffer(base64.b64decode(text), kind).tolist()
    return numbers


def test_asks_for_nothing_from_anywhere() -> None:
    text = page("title", "lead", [Section("One", [Words("words")])]).decode()
    own = text[: text.index("<script>")] + text[text.rindex("<script>") :]  # but for the library's licences
    assert not re.findall(r"https?://|//cdn|@import|url\(|<link|<script src", own)
    assert "default-src 'none'" in own


def test_no_script_may_run_but_its_own() -> None:
    text = page("title", "lead", [Section("One", [Words("words")])]).decode()
    [policy] = re.findall(r'Content-Security-Policy" content="([^"]+)"', text)
    allowed = dict(rule.split(" ", 1) for rule in unescape(policy).split("; "))
    scripts = re.findall(r"<script>(.*?)</script>", text, re.DOTALL)
    digests = [base64.b64encode(hashlib.sha256(script.encode()).digest()).decode() for script in scripts]
    assert allowed["script-src"] == " ".join(f"'sha256-{digest}'" for digest in digests)
    assert len(scripts) == 2
    assert allowed["base-uri"] == allowed["form-action"] == allowed["default-src"] == "'none'"


def test_what_can_be_scrolled_has_a_name() -> None:
    frame = pd.DataFrame({"a": [1]})
    text = page("t", "l", [Section("One", [Table('all "figures"', frame), Source("s.toml", "x")])]).decode()
    names = re.findall(r'<(?:div|pre)[^>]* role="region" aria-label="([^"]+)" tabindex="0"', text)
    assert [unescape(name) for name in names] == ['all "figures"', "s.toml"]
    assert text[text.index("<main>") : text.index("</main>")].count("tabindex") == 2


def test_cells_are_made_once(monkeypatch: pytest.MonkeyPatch) -> None:
    made = []

    def note(value: int) -> Cell:
        made.append(value)
        return Cell(str(value), is_number=True)

    monkeypatch.setattr("evoframe.analysis.page.html._cell", note)
    page("t", "l", [Section("One", [Table("", pd.DataFrame({"a": [1, 2], "b": [3, 4], "c": [5, 6]}))])])
    assert sorted(made) == [1, 2, 3, 4, 5, 6]


def test_what_others_have_written_is_text() -> None:
    bad = "<img src=x onerror=alert(1)></script>"
    frame = pd.DataFrame({bad: [bad]})
    plot = Figure([Scatter(y=[1], name=bad)])
    blocks: list[Block] = [
        Words(bad),
        Source(bad, bad),
        Table(bad, frame),
        Chart(bad, plot),
        Picture(bad, b"<svg/>"),
    ]
    text = page(bad, bad, [Section(bad, blocks)]).decode()
    assert "<img src=x" not in text
    assert text.count("</script>") == 3  # of the chart, the library and the page


def test_sections_have_links_and_those_without_anything_are_left_out() -> None:
    text = page("t", "l", [Section("n = 2", [Words("w")]), Section("Nothing", [])]).decode()
    assert '<a href="#n-2">n = 2</a>' in text
    assert '<section id="n-2"' in text
    assert "Nothing" not in text


def test_sections_of_one_name_have_data_of_their_own() -> None:
    sections = [Section("n = 2", [Chart(str(n), Figure([Scatter(y=[n])]))]) for n in (1, 2)]
    text = page("t", "l", sections).decode()
    own = text[: text.index("</main>")]
    ids = re.findall(r' id="([^"]+)"', own)
    assert len(ids) == len(set(ids))
    for source in re.findall(r'data-source="([^"]+)"', own):
        assert source in ids


def test_what_plotly_would_read_as_markup_is_text() -> None:
    geometry = moving(0.0, 0.1)
    part = attrs.evolve(geometry.parts[0], name="<a href='x'>y</a> & z")
    [drawn] = told(Motion("", attrs.evolve(geometry, parts=(part,)), "tip"))["parts"]
    assert drawn["name"] == "&lt;a href='x'&gt;y&lt;/a&gt; &amp; z"


def test_tables_show_four_digits_and_a_dash_for_nothing() -> None:
    frame = pd.DataFrame({"name": ["a", "b"], "value": [1.23456, float("nan")], "n": [30, 1]})
    rows = [[cell.text for cell in row] for row in Table("", frame).rows]
    assert rows == [["a", "1.235", "30"], ["b", "-", "1"]]
    assert [cell.is_number for cell in Table("", frame).rows[0]] == [False, True, True]


def test_an_empty_table_is_left_out() -> None:
    text = page("t", "l", [Section("Nothing", [Table("caption", pd.DataFrame(columns=["a"]))])]).decode()
    assert "caption" not in text[text.index("<main>") : text.index("</main>")]


def test_the_same_content_gives_the_same_bytes() -> None:
    sections = [
        Section("One", [Motion("m", moving(0.0, 0.1), "tip"), Chart("c", Figure([Scatter(y=[1, 2])]))])
    ]
    assert page("t", "l", sections) == page("t", "l", sections)


@settings(max_examples=50)
@given(st.lists(st.floats(-10, 10), min_size=1, max_size=5))
def test_displacements_are_told_to_a_part_in_sixty_thousand(heights: list[float]) -> None:
    document = told(Motion("", moving(0.0, *heights)))
    [part] = document["parts"]
    moves = document["step"] * np.array(decoded(part["moves"], "<i2")).reshape(-1, 4, 3)
    assert decoded(part["rest"], "<f4") == SQUARE.ravel().tolist()
    largest = max(map(abs, heights))
    assert np.abs(moves[1:, :, 2].T - heights).max() <= max(0.51 * largest / 32767, 1e-9)
    assert not moves[..., :2].any()


@pytest.mark.parametrize(
    ("height", "exaggeration"), [(0.0, 1), (0.005, 20), (0.07, 2), (0.15, 1), (3.0, 1), (0.0009, 100)]
)
def test_what_hardly_moves_is_exaggerated(height: float, exaggeration: int) -> None:
    document = told(Motion("", moving(0.0, height)))
    assert document["exaggeration"] == exaggeration
    assert document["most"] == max(10, 10 * exaggeration)


@pytest.mark.parametrize("height", [1e-10, 1e-17, 5e-324])
def test_rounding_is_no_motion(height: float) -> None:
    document = told(Motion("", moving(0.0, height)))
    assert (document["exaggeration"], document["most"]) == (1, 10)
    assert not any(decoded(document["parts"][0]["moves"], "<i2"))


def test_the_room_that_the_body_needs_is_told() -> None:
    document = told(Motion("", moving(0.0, -0.5, 0.25)))
    assert document["bounds"] == [[0.0, 1.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, -0.5, 0.25]]


def test_the_trace_is_that_of_the_track() -> None:
    assert told(Motion("", moving(0.0, 0.5), "tip"))["track"] == {
        "name": "tip",
        "positions": [[1.0, 1.0, 0.0], [1.0, 1.0, 0.5]],
    }
    assert told(Motion("", moving(0.0, 0.5)))["track"] is None
