"""Corrections of pairwise p-values for multiple comparisons."""

from __future__ import annotations

from typing import Literal, TypeAlias

__all__ = ["CORRECTIONS", "Correction"]

Correction: TypeAlias = Literal["holm", "bonferroni", "fdr_bh", "none"]

CORRECTIONS: tuple[Correction, ...] = ("holm", "bonferroni", "fdr_bh", "none")
"""The names of all corrections; the paper uses ``none``."""
