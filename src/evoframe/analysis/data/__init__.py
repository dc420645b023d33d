"""Data of reports: studies as tidy tables and views, and a run's champion with what can be drawn of it.

Everything that reports read of runs and studies is read here, and checked where a plugin made it.
"""

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
