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

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
