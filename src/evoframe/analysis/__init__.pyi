# The subpackages of the analysis; read by type checkers, and by lazy_loader in __init__.py.

from . import (
    data as data,
    figures as figures,
    output as output,
    page as page,
    report as report,
    robustness as robustness,
    statistics as statistics,
)
from .figures import bodies as bodies, networks as networks

__all__: list[str]
