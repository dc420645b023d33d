"""Statistics of groups of values: tests, effect sizes, corrections, rankings, and conclusions in words.

Groups are independent (:func:`compare`) or were measured under the same circumstances, one after the other
(:func:`compare_blocks`). Nothing here knows of runs or studies.

The list of corrections is all that a command line needs; it loads no library of statistics.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from evoframe.analysis.statistics.corrections import CORRECTIONS, Correction

if TYPE_CHECKING:
    from evoframe.analysis.statistics.blocks import BlockComparison, BlockPair, compare_blocks
    from evoframe.analysis.statistics.groups import (
        FEWEST,
        Comparison,
        Group,
        Pairwise,
        a12,
        compare,
        detectable_a12,
        ranked,
    )
    from evoframe.analysis.statistics.words import conclusion

__all__ = [
    "CORRECTIONS",
    "FEWEST",
    "BlockComparison",
    "BlockPair",
    "Comparison",
    "Correction",
    "Group",
    "Pairwise",
    "a12",
    "compare",
    "compare_blocks",
    "conclusion",
    "detectable_a12",
    "ranked",
]

_MODULES = {
    "BlockComparison": "blocks",
    "BlockPair": "blocks",
    "compare_blocks": "blocks",
    "conclusion": "words",
}

if not TYPE_CHECKING:  # to a type checker a name that is not there is an error

    def __getattr__(name: str) -> Any:
        if name not in __all__:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        return getattr(importlib.import_module(f"{__name__}.{_MODULES.get(name, 'groups')}"), name)
