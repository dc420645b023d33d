"""A report before it is written."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import attrs

from evoframe.analysis.page.html import Section, page

__all__ = ["Draft"]


@attrs.frozen(eq=False)
class Draft:
    """A report before it is written.

    Attributes:
        title: Heading of the page: the run or study.
        lead: Its state, in a line below the heading.
        sections: Of the page.
        files: Name -> bytes, beside the page.
        words: What the command prints.
        facts: Settings listed at the top of the page: label -> value.
    """

    title: str
    lead: str
    sections: Sequence[Section]
    files: Mapping[str, bytes] = attrs.field(repr=False)
    words: str
    facts: Mapping[str, str] = attrs.field(factory=dict)

    def all_files(self) -> dict[str, bytes]:
        """Return all files of the report, the page among them: name -> bytes."""
        return {**self.files, "report.html": page(self.title, self.lead, self.sections, self.facts)}
