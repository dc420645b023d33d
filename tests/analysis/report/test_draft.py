"""Tests of the contents of a report before they are written."""

from __future__ import annotations

from evoframe.analysis.page.html import Section, Words, page
from evoframe.analysis.report.draft import Draft


def test_the_files_include_the_page() -> None:
    sections = [Section("One", [Words("words")])]
    files = Draft("t", "l", sections, {"a.csv": b"1"}, "t: l\n").all_files()
    assert files == {"a.csv": b"1", "report.html": page("t", "l", sections)}
