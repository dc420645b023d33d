"""Statistics of groups of values: tests, effect sizes, corrections, rankings, and conclusions in words.

Groups are independent (:func:`compare`) or were measured under the same circumstances, one after the other
(:func:`compare_blocks`). Nothing here knows of runs or studies.

The list of corrections is all that a command line needs; it loads no library of statistics.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
