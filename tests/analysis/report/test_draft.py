"""A draft is all files of a report, none of which is there yet."""

from __future__ import annotations

from evoframe.analysis.page.html import Section, Words, page
from evoframe.analysis.report.draft import Draft


def test_its_page_is_one_of_its_files() -> None:
    sections = [Section("One", [Words("words")])]
    files = Draft("t", "l", sections, {"a.csv": b"1"}, "t: l\n").all_files()
    assert files == {"a.csv": b"1", "report.html": page("t", "l", sections)}
