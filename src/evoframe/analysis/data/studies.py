"""The rows of a study as tidy tables."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Literal, TypeAlias

import attrs
import pandas as pd

from evoframe.analysis.data.facts import facts_of
from evoframe.analysis.statistics.groups import ranked
from evoframe.contract import unit_of
from evoframe.documents import differences
from evoframe.errors import InputError
from evoframe.files import LARGEST_DOCUMENT, is_file, read_text, shown_name
from evoframe.registry import Plugins, discover
from evoframe.study import (
    STUDY_FILE,
    Row,
    called,
    gather,
    headings,
    imported_rows,
    mixed_generations,
    read_study,
    shown,
    survey,
    title_of,
)

__all__ = ["YARDSTICKS", "StudyData", "View", "Yardstick", "load_study"]

Yardstick: TypeAlias = Literal["score", "fitness"]

YARDSTICKS: tuple[Yardstick, ...] = ("score", "fitness")
"""Score of the best pair, which is comparable across aggregators; best fitness, which the paper reports."""


@attrs.frozen
class StudyData:
    """A study, and a row for each of its finished runs.

    Attributes:
        label: Name of the study.
        keys: Keys of the grid; may be empty. The values of the last key are compared.
        unit: Unit of the scores.
        planned: Number of planned runs.
        rows: Rows of the finished runs, in the order of execution.
        alike: True if all configurations simulate and score in the same way.
        best_run: Directory of the run with the best pair, among the runs whose directories exist.
        settings: Text of the study file.
        values: Key of the grid -> text of a value in rows -> the value, if it is a number or a string.
        directory: Directory of the study.
        facts: Settings that a reader needs first: label -> values.
        mixed: Components whose results have several bit generations, with these, as in
            ``simulator 'vox': 1 and 2``.
    """

    label: str
    keys: tuple[str, ...]
    unit: str
    planned: int
    rows: tuple[Row, ...] = attrs.field(repr=False)
    alike: bool = True
    best_run: Path | None = None
    settings: str = attrs.field(default="", repr=False)
    values: Mapping[str, Mapping[str, Any]] = attrs.field(factory=dict, repr=False)
    directory: Path = Path()
    facts: Mapping[str, str] = attrs.field(factory=dict, repr=False)
    mixed: tuple[str, ...] = ()

    @property
    def frame(self) -> pd.DataFrame:
        """One line per run: the keys of the grid, and all results."""
        others = {"settings", "score_curve", "fitness_curve"}
        return pd.DataFrame(
            [
                {**self._settings(row), **attrs.asdict(row, filter=lambda field, _: field.name not in others)}
                for row in self.rows
            ]
        )

    @property
    def curves(self) -> pd.DataFrame:
        """One line per run and generation: the keys of the grid, the score and the fitness."""
        return pd.DataFrame(
            [
                {
                    **self._settings(row),
                    "run": row.run,
                    "generation": generation,
                    "score": score,
                    "fitness": fitness,
                }
                for row in self.rows
                for generation, (score, fitness) in enumerate(
                    zip(row.score_curve, row.fitness_curve, strict=True)
                )
            ]
        )

    def _settings(self, row: Row) -> dict[str, Any]:
        return {key: self.values.get(key, {}).get(text, text) for key, text in row.settings.items()}

    def views(self, yardstick: Yardstick) -> list[View]:
        """Return a view for each combination of all keys but the last, which distinguishes its groups.

        If there are several views, one more compares the best group of each, which has the greatest mean rank
        on the *yardstick*. Its name includes that of its view, as in ``WM (n = 2)``. A study with an empty
        grid has one view of one group, ``all``.
        """
        if not self.keys:
            return [View(self.label, "group", {"all": self.rows})]
        found: dict[tuple[str, ...], dict[str, list[Row]]] = {}
        for row in self.rows:
            groups = found.setdefault(tuple(row.settings[key] for key in self.keys[:-1]), {})
            groups.setdefault(called(row.settings[self.keys[-1]]), []).append(row)
        names = headings(self.keys)
        titles = [title_of(dict(zip(self.keys, values, strict=False)), names) for values in found]
        views = [
            View(title or self.label, names[self.keys[-1]], groups)
            for title, groups in zip(titles, found.values(), strict=True)
        ]
        if len(views) < 2:
            return views
        best: dict[str, Sequence[Row]] = {}
        for view in views:
            name = ranked(view.values(yardstick))[0].name
            best[f"{name} ({view.title})"] = view.groups[name]
        return [*views, View("best of each", views[0].key, best)]


@attrs.frozen
class View:
    """Groups of runs to compare.

    Attributes:
        title: Setting that the groups share: ``n = 2``.
        key: Setting that distinguishes the groups: ``aggregator``.
        groups: Name -> runs of the group.
    """

    title: str
    key: str
    groups: Mapping[str, Sequence[Row]] = attrs.field(repr=False)

    def values(self, yardstick: Yardstick) -> dict[str, list[float]]:
        """Return the final values of each group."""
        return {name: [getattr(row, yardstick) for row in rows] for name, rows in self.groups.items()}


def load_study(directory: str | Path, *, plugins: Plugins | None = None) -> StudyData:
    """Return a study and its finished runs.

    Args:
        directory: Directory of the study.
        plugins: Plugins that its configurations name; by default the installed ones.

    Raises:
        ConfigurationError: The study cannot be read with these plugins.
        InputError: *directory* does not contain a study, or one of its runs is damaged.
    """
    directory = Path(directory)
    if not is_file(directory / STUDY_FILE):
        raise InputError(f"found no {STUDY_FILE}, expected the directory of a study", source=directory)
    study = read_study(directory / STUDY_FILE, (), plugins or discover())
    imported = imported_rows(study, directory)
    statuses = survey(study, directory, imported, rows=True)
    rows = gather(statuses, imported)
    units = {unit_of(cell.config.objective.component) for cell in study.cells}
    first, *others = [cell.config.simulation() for cell in study.cells]
    here = {run.directory: row.score for run, row in rows.items() if statuses[run].state == "finished"}
    unit = units.pop() if len(units) == 1 else ""
    return StudyData(
        label=shown_name(directory),
        keys=tuple(study.grid),
        unit=unit,
        planned=len(statuses),
        rows=tuple(rows.values()),
        alike=not any(differences(first, other) for other in others),
        best_run=max(here, key=here.__getitem__, default=None),
        settings=read_text(directory / STUDY_FILE, LARGEST_DOCUMENT),
        values={
            key: {shown(value): value for value in values if isinstance(value, str | int | float)}
            for key, values in study.grid.items()
        },
        directory=directory,
        facts=facts_of([cell.config.tables() for cell in study.cells], unit),
        mixed=tuple(mixed_generations(rows)),
    )
