"""Meaning of a verification in one sentence."""

from __future__ import annotations

from evoframe.contract import Design, RunConfig, SupportsVariants
from evoframe.messages import quantity
from evoframe.record import Verification

__all__ = ["verdict"]

_KEPT = (0.9, 1.1)
_LOST = 0.5


def verdict(verification: Verification, config: RunConfig, design: Design) -> str:
    """Return what the findings mean for the score, in the words of the simulator.

    A variant with 90 to 110 % of the score, or at most 50 %, contributes its clause, any other one its name.
    Both are followed by the share of the score that is left. For a design that diverges out of reach of the
    samples, only this is stated.

    Args:
        verification: The verification of *design*.
        config: The configuration with which it was simulated.
        design: The design.

    Returns:
        A sentence; empty if the unchanged design has no score or the simulator offers no variants.
    """
    seen = verification.within_reach
    if seen is not None:
        diverges = f"diverges at step {verification.unchanged.diverged_at}, out of reach of the samples"
        return f"The design {diverges}; its score of {quantity(seen, verification.unit)} does not show it."
    simulator = config.simulator.component
    if not isinstance(simulator, SupportsVariants) or not verification.unchanged.value:
        return ""
    variants = {each.name: each for each in simulator.variants(design, config.objective.component.record)}
    clauses = []
    for finding in verification.findings:
        variant = variants.get(finding.name)
        share = verification.share(finding)
        clause = "" if variant is None or share is None else _clause(share, variant.kept, variant.lost)
        clauses.append(_described(clause, finding.name, share))
    return f"The score {_listed(clauses)}." if clauses else ""


def _described(clause: str, name: str, share: float | None) -> str:
    if share is None:
        return f"diverges with {name}"
    return f"{clause} ({share:z.0%} of unchanged)" if clause else f"becomes {share:z.0%} with {name}"


def _listed(clauses: list[str]) -> str:
    *others, last = clauses
    return f"{'; '.join(others)}; and {last}" if others else last


def _clause(share: float, kept: str, lost: str) -> str:
    if _KEPT[0] <= share <= _KEPT[1]:
        return kept
    return lost if share <= _LOST else ""
