"""Data of reports: studies as tidy tables and views, and a run's champion with its geometry and networks.

Reports read runs and studies only through this subpackage, which validates the output of plugins.
"""

import evoframe.analysis.drawing  # noqa: F401 - before others import matplotlib
from evoframe.analysis.data.champions import ChampionData, DrawnNetwork, load_champion
from evoframe.analysis.data.studies import YARDSTICKS, StudyData, View, Yardstick, load_study
from evoframe.analysis.data.tables import Compared, comparisons

__all__ = [
    "YARDSTICKS",
    "ChampionData",
    "Compared",
    "DrawnNetwork",
    "StudyData",
    "View",
    "Yardstick",
    "comparisons",
    "load_champion",
    "load_study",
]
