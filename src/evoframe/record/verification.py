"""Verification of a score: the design is simulated again with one thing changed at a time."""

from __future__ import annotations

import math
import statistics
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import attrs

from evoframe.contract import Score
from evoframe.errors import InputError
from evoframe.files import write_json
from evoframe.record.layout import VERIFICATION_FILE

__all__ = [
    "UNCHANGED",
    "WITHIN_REACH",
    "Finding",
    "Verification",
    "keep_verification",
    "verification_from_json",
]

UNCHANGED = "unchanged"
"""Name of the unchanged simulation, with which all others are compared."""

WITHIN_REACH = "within reach of the samples"
"""Name of the simulation whose score does not see the divergence of the unchanged one."""

_FORMAT = 1


@attrs.frozen
class Finding:
    """The scores of a design with one thing changed.

    Attributes:
        name: Name of the change.
        scores: One score per draw if the change is random, else one score.
    """

    name: str
    scores: tuple[Score, ...]

    @property
    def values(self) -> list[float]:
        """The scores of the draws that did not diverge, ascending."""
        return sorted(score.value for score in self.scores if score.value is not None)

    @property
    def median(self) -> float | None:
        """The median of the draws that did not diverge, in the objective's unit; ``None`` if all did."""
        values = self.values
        return statistics.median(values) if values else None

    @property
    def diverged_at(self) -> list[int]:
        """The steps at which draws diverged, ascending."""
        return sorted(score.diverged_at for score in self.scores if score.diverged_at is not None)


@attrs.frozen
class Verification:
    """The verification table of one design (docs/experiment.md, "What the setting rewards").

    Attributes:
        unchanged: Score of the unchanged design.
        findings: Its scores with one thing changed, in the order of the simulator's variants; before them, if
            the unchanged design diverges out of reach of all samples, the score that does not see it.
        unit: Unit of all scores; empty if the objective declares none.
        score: Its score in the run, if the design is a champion simulated as in its run.
    """

    unchanged: Score
    findings: tuple[Finding, ...]
    unit: str = ""
    score: float | None = None

    @property
    def rows(self) -> tuple[Finding, ...]:
        """The unchanged design as a finding, followed by all other findings."""
        return (Finding(UNCHANGED, (self.unchanged,)), *self.findings)

    @property
    def within_reach(self) -> float | None:
        """Score if the design diverges out of reach of the samples, in the objective's unit; or ``None``."""
        found = [finding for finding in self.findings if finding.name == WITHIN_REACH]
        return found[0].median if found and self.unchanged.value is None else None

    def share(self, finding: Finding) -> float | None:
        """Return the median of *finding* as a fraction of the unchanged score; ``None`` if undefined."""
        if finding.median is None or not self.unchanged.value:
            return None
        share = finding.median / self.unchanged.value
        return share if math.isfinite(share) else None

    def to_json(self) -> dict[str, Any]:
        """Return the table as JSON values, exact to the last bit."""
        return {
            "format": _FORMAT,
            "score": self.score,
            "unit": self.unit,
            "variants": [self._row(finding) for finding in self.rows],
        }

    def _row(self, finding: Finding) -> dict[str, Any]:
        values = finding.values
        return {
            "name": finding.name,
            "median": finding.median,
            "least": values[0] if values else None,
            "greatest": values[-1] if values else None,
            "share": self.share(finding),
            "draws": [{"score": score.value, "diverged_at": score.diverged_at} for score in finding.scores],
        }


def keep_verification(directory: Path, verification: Verification) -> None:
    """Write the verification of a run's champion to the run's directory, for :meth:`Run.verification`.

    Raises:
        RunError: The file cannot be written.
    """
    write_json(directory / VERIFICATION_FILE, verification.to_json())


def verification_from_json(document: Any) -> Verification:
    """Return the verification that :meth:`Verification.to_json` wrote.

    Raises:
        InputError: The document is not a verification.
    """
    if not isinstance(document, Mapping) or "variants" not in document:
        raise InputError("not a verification of evoframe")
    if document.get("format") is True or document.get("format") != _FORMAT:
        raise InputError(f"expected {_FORMAT}, found {document.get('format')!r}", key="format")
    try:
        rows = [_finding(row) for row in document["variants"]]
        if not rows or len(rows[0].scores) != 1:
            raise ValueError("expected one score of the unchanged design")  # noqa: TRY301 - wrapped below
        verification = Verification(rows[0].scores[0], tuple(rows[1:]), document["unit"], document["score"])
        same = verification.to_json() == document
    except ValueError as error:
        raise InputError(f"not written by evoframe: {error}", key="variants") from error
    except (AttributeError, KeyError, TypeError) as error:
        raise InputError("not written by evoframe: damaged rows", key="variants") from error
    if not same:
        raise InputError("not written by evoframe: its figures do not follow from its scores")
    return verification


def _finding(row: Mapping[str, Any]) -> Finding:
    return Finding(row["name"], tuple(_draw(draw["score"], draw["diverged_at"]) for draw in row["draws"]))


def _draw(value: Any, diverged_at: Any) -> Score:
    has_value = isinstance(value, float) and math.isfinite(value) and diverged_at is None
    has_diverged = value is None and type(diverged_at) is int
    if not (has_value or has_diverged):
        raise ValueError(f"expected a score or the step of a divergence, found {value!r} and {diverged_at!r}")
    return Score(value, diverged_at)
