"""Analysis: from runs, studies and measurements to statistics, figures, tables, pages and reports.

Each room does one thing; lower ones know nothing of higher ones:

- ``report``: the report of a run or a study, written as files.
- ``robustness``: tests, tables, figure and words of a measurement of robustness.
- ``page``: a self-contained HTML page with charts and a moving body.
- ``figures``: figures for print; ``bodies`` and ``networks`` are two of its modules.
- ``data``: runs and studies as tables, and the champion with what can be drawn of it.
- ``statistics``: tests, effect sizes, rankings and conclusions for any groups of values.
- ``output``: files, names of files, and texts made of templates.

All of it needs the extra ``report``. Importing this package loads none of its libraries; the first use of a
room does.
"""

from __future__ import annotations

import importlib
from types import ModuleType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from evoframe.analysis import data, figures, output, page, report, robustness, statistics
    from evoframe.analysis.figures import bodies, networks

__all__ = [
    "bodies",
    "data",
    "figures",
    "networks",
    "output",
    "page",
    "report",
    "robustness",
    "statistics",
]

_MODULES = {"bodies": "figures.bodies", "networks": "figures.networks"}

if not TYPE_CHECKING:  # to a type checker a name that is not there is an error

    def __getattr__(name: str) -> ModuleType:
        if name not in __all__:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        return importlib.import_module(f"{__name__}.{_MODULES.get(name, name)}")
