"""Content of a page."""

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
from evoframe.analysis.data.samples import Sample
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
    """Return a square of 1 m x 1 m at several heights."""
    vertices = np.array([SQUARE + np.array([0, 0, height]) for height in heights])
    part = GeometryPart("square", "#CC3311", opacity, vertices, FACES)
    return Geometry(np.arange(float(len(heights))), (part,), {"tip": vertices[:, 2]})


def document_of(motion: Motion) -> dict[str, Any]:
    document: dict[str, Any] = json.loads(motion.json)
    return document


def decoded(text: str, kind: str) -> list[float]:
    numbers: list[float] = np.frombuffer(base64.b64decode(text), kind).tolist()
    return numbers


def test_requests_no_other_file() -> None:
    text = page("title", "lead", [Section("One", [Words("words")])]).decode()
    # Without plotly, whose licenses contain addresses.
    own = text[: text.index("<script>")] + text[text.rindex("<script>") :]
    assert not re.findall(r"https?://|//cdn|@import|url\(|<link|<script src", own)
    assert "default-src 'none'" in own


def test_only_its_own_scripts_may_run() -> None:
    text = page("title", "lead", [Section("One", [Words("words")])]).decode()
    [policy] = re.findall(r'Content-Security-Policy" content="([^"]+)"', text)
    allowed = dict(rule.split(" ", 1) for rule in unescape(policy).split("; "))
    scripts = re.findall(r"<script>(.*?)</script>", text, re.DOTALL)
    digests = [base64.b64encode(hashlib.sha256(script.encode()).digest()).decode() for script in scripts]
    assert allowed["script-src"] == " ".join(f"'sha256-{digest}'" for digest in digests)
    assert len(scripts) == 2
    assert allowed["base-uri"] == allowed["form-action"] == allowed["default-src"] == "'none'"


def test_scrollable_regions_have_names() -> None:
    frame = pd.DataFrame({"a": [1]})
    text = page("t", "l", [Section("One", [Table('all "figures"', frame), Source("s.toml", "x")])]).decode()
    names = re.findall(r'<(?:div|pre)[^>]* role="region" aria-label="([^"]+)" tabindex="0"', text)
    assert [unescape(name) for name in names] == ['all "figures"', "s.toml"]
    assert text[text.index("<main>") : text.index("</main>")].count("tabindex") == 2


def test_cells_are_created_once(monkeypatch: pytest.MonkeyPatch) -> None:
    created = []

    def note(value: int) -> Cell:
        created.append(value)
        return Cell(str(value), is_number=True)

    monkeypatch.setattr("evoframe.analysis.page.html._cell", note)
    page("t", "l", [Section("One", [Table("", pd.DataFrame({"a": [1, 2], "b": [3, 4], "c": [5, 6]}))])])
    assert sorted(created) == [1, 2, 3, 4, 5, 6]


def test_content_from_others_is_escaped() -> None:
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
    text = page(bad, bad, [Section(bad, blocks)], {bad: bad}).decode()
    assert "<img src=x" not in text
    assert text.count("</script>") == 3  # chart, library, page


def test_sections_have_links_and_empty_sections_are_omitted() -> None:
    text = page("t", "l", [Section("n = 2", [Words("w")]), Section("Nothing", [])]).decode()
    assert '<a href="#n-2">n = 2</a>' in text
    assert '<section id="n-2"' in text
    assert "Nothing" not in text


def test_sections_with_the_same_name_have_separate_data() -> None:
    sections = [Section("n = 2", [Chart(str(n), Figure([Scatter(y=[n])]))]) for n in (1, 2)]
    text = page("t", "l", sections).decode()
    own = text[: text.index("</main>")]
    ids = re.findall(r' id="([^"]+)"', own)
    assert len(ids) == len(set(ids))
    for source in re.findall(r'data-source="([^"]+)"', own):
        assert source in ids


def test_markup_in_names_is_escaped_for_plotly() -> None:
    geometry = moving(0.0, 0.1)
    part = attrs.evolve(geometry.parts[0], name="<a href='x'>y</a> & z")
    [drawn] = document_of(Motion("", attrs.evolve(geometry, parts=(part,)), "tip"))["parts"]
    assert drawn["name"] == "&lt;a href='x'&gt;y&lt;/a&gt; &amp; z"
    assert drawn["label"] == part.name  # the legend of the page, which inserts it as text


def test_tables_show_four_digits_and_a_dash_for_missing_values() -> None:
    frame = pd.DataFrame({"name": ["a", "b"], "value": [1.23456, float("nan")], "n": [30, 1]})
    rows = [[cell.text for cell in row] for row in Table("", frame).rows]
    assert rows == [["a", "1.235", "30"], ["b", "-", "1"]]
    assert [cell.is_number for cell in Table("", frame).rows[0]] == [False, True, True]


def test_facts_are_listed_above_the_sections() -> None:
    text = page("t", "l", [], {"objective": "tip-dz (mm)", "seed": "3"}).decode()
    assert re.findall(r"<dt>(.*?)</dt><dd>(.*?)</dd>", text) == [("objective", "tip-dz (mm)"), ("seed", "3")]
    assert text.index("<dt>") < text.index("<main>")
    assert "<dt>" not in page("t", "l", []).decode()


def test_an_empty_table_is_omitted() -> None:
    text = page("t", "l", [Section("Nothing", [Table("caption", pd.DataFrame(columns=["a"]))])]).decode()
    assert "caption" not in text[text.index("<main>") : text.index("</main>")]


def test_the_same_content_gives_the_same_bytes() -> None:
    sections = [
        Section("One", [Motion("m", moving(0.0, 0.1), "tip"), Chart("c", Figure([Scatter(y=[1, 2])]))])
    ]
    assert page("t", "l", sections) == page("t", "l", sections)


@settings(max_examples=50)
@given(st.lists(st.floats(-10, 10), min_size=1, max_size=5))
def test_displacements_are_stored_to_one_part_in_sixty_thousand(heights: list[float]) -> None:
    document = document_of(Motion("", moving(0.0, *heights)))
    [part] = document["parts"]
    moves = document["step"] * np.array(decoded(part["moves"], "<i2")).reshape(-1, 4, 3)
    assert decoded(part["rest"], "<f4") == SQUARE.ravel().tolist()
    largest = max(map(abs, heights))
    assert np.abs(moves[1:, :, 2].T - heights).max() <= max(0.51 * largest / 32767, 1e-9)
    assert not moves[..., :2].any()


@pytest.mark.parametrize(
    ("height", "exaggeration"), [(0.0, 1), (0.005, 20), (0.07, 2), (0.15, 1), (3.0, 1), (0.0009, 100)]
)
def test_small_displacements_are_exaggerated(height: float, exaggeration: int) -> None:
    document = document_of(Motion("", moving(0.0, height)))
    assert document["exaggeration"] == exaggeration
    assert document["most"] == max(10, 10 * exaggeration)


@pytest.mark.parametrize("height", [1e-10, 1e-17, 5e-324])
def test_rounding_is_not_motion(height: float) -> None:
    document = document_of(Motion("", moving(0.0, height)))
    assert (document["exaggeration"], document["most"]) == (1, 10)
    assert not any(decoded(document["parts"][0]["moves"], "<i2"))


def test_bounds_contain_the_body_and_its_displacements() -> None:
    document = document_of(Motion("", moving(0.0, -0.5, 0.25)))
    assert document["bounds"] == [[0.0, 1.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, -0.5, 0.25]]


def test_the_trace_follows_the_track() -> None:
    assert document_of(Motion("", moving(0.0, 0.5), "tip"))["track"] == {
        "label": "tip",
        "name": "tip",
        "positions": [[1.0, 1.0, 0.0], [1.0, 1.0, 0.5]],
    }
    assert document_of(Motion("", moving(0.0, 0.5)))["track"] is None


def test_the_sentence_on_samples_gives_their_times_and_the_displacement_between_them() -> None:
    first = Sample("sample 0", 0.0032, (1.0, 0.0, 0.002))
    last = Sample("sample 5", 0.0673, (1.001, 0.0, 0.0094))
    motion = Motion("", moving(0.0, 0.1), "tip", (first, last))
    numbers = re.findall(r"(?:[xyz] )?[+-]?\d+\.\d+ m?m?s?", motion.compared)
    assert numbers == ["0.0032 s", "0.0673 s", "x +1.000 mm", "y +0.000 mm", "z +7.400 mm"]
    assert first.name in motion.compared
    assert last.name in motion.compared
    text = page("t", "l", [Section("One", [motion])]).decode()
    assert motion.compared in text
    samples = document_of(motion)["samples"]
    assert [(each["name"], each["time"]) for each in samples] == [("sample 0", 0.0032), ("sample 5", 0.0673)]


def test_without_two_samples_there_is_no_sentence() -> None:
    one = (Sample("sample 0", 0.0, (0.0, 0.0, 0.0)),)
    for motion in (
        Motion("", moving(0.0)),
        Motion("", moving(0.0), "tip", one),
        Motion("", moving(0.0), None, one * 2),
    ):
        assert motion.compared == ""
        assert 'class="compared"' not in page("t", "l", [Section("One", [motion])]).decode()
