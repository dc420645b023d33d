"""Results of two commits for the same designs."""

from __future__ import annotations

from collections.abc import Sequence

import attrs

__all__ = ["Result", "difference"]


@attrs.frozen
class Result:
    """Result of a design.

    Attributes:
        score: Its score; ``None`` if its simulation diverged.
        tracks: Digest of the recorded tracks; empty if they are not known.
        steps: Number of simulated steps; 0 if it is not known.
    """

    score: float | None
    tracks: str
    steps: int


def difference(first: Sequence[Result], second: Sequence[Result]) -> str:
    """Describe the difference between the results of two commits for the same designs."""
    if first == second:
        return "equal bit for bit"
    if len(first) != len(second):
        return f"{len(first):,} and {len(second):,} pairs"
    scores = [(one.score, other.score) for one, other in zip(first, second, strict=True)]
    gaps = [abs(one - other) for one, other in scores if one is not None and other is not None]
    diverging = sum((one is None) != (other is None) for one, other in scores)
    parts = []
    if any(gaps):
        parts.append(f"scores differ by up to {max(gaps):.2g}")
    if diverging:
        parts.append(f"{diverging:,} of {len(scores):,} diverge in one only")
    return ", ".join(parts) or "equal scores, different tracks"
