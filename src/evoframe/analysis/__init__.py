"""Analysis: from runs, studies and measurements to statistics, figures, tables, pages and reports.

Each subpackage does one thing, and imports only from subpackages below it in this list:

- ``report``: the report of a run or a study, written as files.
- ``robustness``: tests, tables, figure and conclusions of a measurement of robustness.
- ``page``: a self-contained HTML page with charts and an animated body.
- ``figures``: figures for print; ``bodies`` and ``networks`` are two of its modules.
- ``data``: runs and studies as tables, and the champion with its geometry and networks.
- ``statistics``: tests, effect sizes, rankings and conclusions for groups of values.
- ``output``: files, file names, and texts rendered from templates.

All of it requires the extra ``report``. Importing this package does not load the libraries of the extra; the
first use of a subpackage does.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
