"""How p-values of many pairs are corrected for their number."""

from __future__ import annotations

from typing import Literal, TypeAlias

__all__ = ["CORRECTIONS", "Correction"]

Correction: TypeAlias = Literal["holm", "bonferroni", "fdr_bh", "none"]

CORRECTIONS: tuple[Correction, ...] = ("holm", "bonferroni", "fdr_bh", "none")
"""``none`` is what the paper does."""
