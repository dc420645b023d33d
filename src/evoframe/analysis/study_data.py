"""The rows of a study as tidy tables."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from pathlib import Path
from typing import Any, Literal, TypeAlias

import attrs
import pandas as pd

from evoframe.discovery import discover
from evoframe.plugins import Plugins
from evoframe.study.conduct import STUDY_FILE, survey
from evoframe.study.gathered import gather, imported_rows
from evoframe.study.plan import Study, read_study
from evoframe.study.rows import Row

__all__ = ["YARDSTICKS", "StudyData", "Yardstick", "load_study"]

Yardstick: TypeAlias = Literal["score", "fitness"]

YARDSTICKS: tuple[Yardstick, ...] = ("score", "fitness")
"""The score of the best pair, which is the same measure for all, and the averaged fitness, as published."""


@attrs.frozen
class StudyData:
    """A study, and a row for each of its finished runs.

    Attributes:
        label: What a person calls it.
        keys: The keys of the grid. The last one is that whose values are compared; the others part the study
            into panels.
        unit: Of the scores.
        planned: How many runs there shall be.
        rows: Of the finished ones, in the order of work.
    """

    label: str
    keys: tuple[str, ...]
    unit: str
    planned: int
    rows: tuple[Row, ...] = attrs.field(repr=False)

    @property
    def frame(self) -> pd.DataFrame:
        """One line for each run: the keys of the grid, and all figures."""
        return pd.DataFrame([_figures(row) for row in self.rows])

    @property
    def curves(self) -> pd.DataFrame:
        """One line for each run and generation: the keys of the grid, and both yardsticks."""
        return pd.DataFrame(
            [
                {**row.settings, "run": row.run, "generation": generation, "score": score, "fitness": fitness}
                for row in self.rows
                for generation, (score, fitness) in enumerate(
                    zip(row.score_curve, row.fitness_curve, strict=True)
                )
            ]
        )

    @property
    def panels(self) -> list[dict[str, str]]:
        """The combinations of all keys but the last, in the order of work."""
        found = {tuple(row.settings[key] for key in self.keys[:-1]): None for row in self.rows}
        return [dict(zip(self.keys[:-1], values, strict=True)) for values in found]

    @cached_property
    def compared(self) -> list[str]:
        """The values of the last key, in the order of work."""
        return list(dict.fromkeys(row.settings[self.keys[-1]] for row in self.rows))

    def of(self, panel: dict[str, str]) -> dict[str, list[Row]]:
        """Return the rows of a panel, by the value of the last key."""
        inside = [row for row in self.rows if panel.items() <= row.settings.items()]
        return {
            value: [row for row in inside if row.settings[self.keys[-1]] == value]
            for value in self.compared
            if any(row.settings[self.keys[-1]] == value for row in inside)
        }


def load_study(directory: str | Path, *, plugins: Plugins | None = None) -> StudyData:
    """Return a study and what is finished of it.

    Args:
        directory: Its directory.
        plugins: The plugins that its configurations name; by default those that are installed.

    Raises:
        ConfigurationError: It is no study, or cannot be read with these plugins.
        InputError: One of its runs is damaged.
    """
    directory = Path(directory)
    study = read_study(directory / STUDY_FILE, (), plugins or discover())
    elsewhere = [planned.directory for planned in imported_rows(study, directory)]
    statuses = survey(study, directory, elsewhere)
    finished = [planned for planned, status in statuses.items() if status.state == "finished"]
    rows = gather(study, directory, finished)
    return StudyData(directory.name, tuple(study.grid), _unit(study), len(statuses), tuple(rows))


def _unit(study: Study) -> str:
    units: Sequence[str] = [str(getattr(c.config.objective.component, "unit", "")) for c in study.cells]
    return units[0] if len(set(units)) == 1 else ""


def _figures(row: Row) -> dict[str, Any]:
    figures = attrs.asdict(row, filter=lambda field, _: not field.name.endswith("_curve"))
    return {**figures.pop("settings"), **figures}
