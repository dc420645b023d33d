"""Statistics of groups of values: tests, effect sizes, corrections, rankings, and written conclusions.

Groups are independent (:func:`compare`) or measured under the same conditions (:func:`compare_blocks`). This
subpackage does not depend on runs or studies.

Importing the list of corrections, which the command line needs, loads no statistics library.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
