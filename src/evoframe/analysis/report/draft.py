"""Contents of a report before they are written."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import attrs

from evoframe.analysis.page.html import Section, page

__all__ = ["Draft"]


@attrs.frozen(eq=False)
class Draft:
    """Contents of a report before they are written.

    Attributes:
        title: Heading of the page: the name of the run or study.
        lead: Line below the heading: the state of the run or study.
        sections: Sections of the page.
        files: Name -> bytes of all files except the page.
        words: Text that the command prints.
        facts: Settings listed at the top of the page: label -> value.
    """

    title: str
    lead: str
    sections: Sequence[Section]
    files: Mapping[str, bytes] = attrs.field(repr=False)
    words: str
    facts: Mapping[str, str] = attrs.field(factory=dict)

    def all_files(self) -> dict[str, bytes]:
        """Return all files of the report, including the page: name -> bytes."""
        return {**self.files, "report.html": page(self.title, self.lead, self.sections, self.facts)}
