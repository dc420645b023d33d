"""Studies: a grid of configurations, each run several times, and the rows of the finished runs."""

from evoframe.study.api import StudyPlan, StudyResult, plan_study, run_study
from evoframe.study.conduct import STUDY_FILE, Watcher, claim, survey
from evoframe.study.directory import is_study, runs_in
from evoframe.study.estimate import Estimate
from evoframe.study.gathered import IMPORTED, TABLES, gather, imported_rows, mixed_generations
from evoframe.study.names import called, headings, name_of, title_of
from evoframe.study.plan import Cell, Planned, Study, describes_study, read_study, shown, study_names
from evoframe.study.pool import End
from evoframe.study.progress import Status
from evoframe.study.rows import CURVES_FILE, ROWS_FILE, Row, read_rows, row_of, score_curve, write_rows

__all__ = [
    "CURVES_FILE",
    "IMPORTED",
    "ROWS_FILE",
    "STUDY_FILE",
    "TABLES",
    "Cell",
    "End",
    "Estimate",
    "Planned",
    "Row",
    "Status",
    "Study",
    "StudyPlan",
    "StudyResult",
    "Watcher",
    "called",
    "claim",
    "describes_study",
    "gather",
    "headings",
    "imported_rows",
    "is_study",
    "mixed_generations",
    "name_of",
    "plan_study",
    "read_rows",
    "read_study",
    "row_of",
    "run_study",
    "runs_in",
    "score_curve",
    "shown",
    "study_names",
    "survey",
    "title_of",
    "write_rows",
]
