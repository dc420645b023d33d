# The module of each name; read by type checkers, and by lazy_loader in __init__.py.

from .blocks import (
    BlockComparison as BlockComparison,
    BlockPair as BlockPair,
    compare_blocks as compare_blocks,
)
from .corrections import CORRECTIONS as CORRECTIONS, Correction as Correction
from .groups import (
    FEWEST as FEWEST,
    Comparison as Comparison,
    Group as Group,
    Pairwise as Pairwise,
    a12 as a12,
    compare as compare,
    detectable_a12 as detectable_a12,
    ranked as ranked,
)
from .words import conclusion as conclusion

__all__: list[str]
