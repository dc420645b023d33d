"""Studies as read from TOML: their cells, and the seeds and directories of their runs."""

from __future__ import annotations

import functools
import hashlib
import itertools
import json
import math
import re
from collections.abc import Iterable, Iterator, Mapping
from importlib.resources import files
from pathlib import Path
from typing import Any, TypeAlias

import attrs

from evoframe.config import Layer, Layers, layer_of, read_layers, resolve_layers
from evoframe.contract import RunConfig, sizes_of, unit_of
from evoframe.documents import Tree
from evoframe.errors import ConfigurationError
from evoframe.evolution import first_meetings
from evoframe.files import exists
from evoframe.messages import found, suggestion
from evoframe.registry import Plugins, discover
from evoframe.study.names import headings

__all__ = ["Cell", "Planned", "Study", "describes_study", "read_study", "shown", "study_names"]

Settings: TypeAlias = tuple[tuple[str, Any], ...]
"""Dotted key and value, in the order of the grid."""

_KEY = re.compile(r"[a-z0-9_-]+(\.[a-z0-9_-]+)*")
_PLAIN = re.compile(r"[A-Za-z0-9][A-Za-z0-9._+-]{0,60}")
_OWN_KEYS = {
    "runs": "the number of runs of each configuration, as in runs = 10",
    "grid": 'a table of keys, each with a list of values, as in aggregator = ["am", "wm"]',
}
_MOST_RUNS = 1_000_000


@attrs.frozen(eq=False)
class Cell:
    """A configuration of a study.

    Attributes:
        settings: The settings of the grid that define this cell.
        config: The complete configuration, with the study's base seed.
    """

    settings: Settings
    config: RunConfig = attrs.field(repr=False)

    @property
    def label(self) -> str:
        """Name in messages, such as ``aggregator=am, collaboration.n=2``."""
        return ", ".join(f"{key}={shown(value)}" for key, value in self.settings) or "all"

    @property
    def unit(self) -> str:
        """Unit of the scores; empty if the objective does not state one."""
        return unit_of(self.config.objective.component)

    @property
    def values(self) -> list[str]:
        """The values of its settings as text, in the order of the grid."""
        return [shown(value) for _, value in self.settings]

    @property
    def folder(self) -> Path:
        """Path of its runs within the directory of the study, with a level for each key."""
        return Path(*(f"{key}={_plain(value)}" for key, value in self.settings))

    @functools.cached_property
    def pairs(self) -> int:
        """Largest number of pairs that a run scores, including repeats, without the final pair."""
        config, populations = self.config, self.config.populations
        generation = 0
        for name, population in populations.items():
            strategy = config.chosen_for(name, "collaboration")[1].component
            teams = [max(sizes_of(strategy, p.size)) for other, p in populations.items() if other != name]
            # All other populations give the same number of teams: the configuration was validated.
            generation += population.size * population.turns * max(teams, default=1)
        sizes = [population.size for population in populations.values()]
        return len(first_meetings(sizes)) + config.run.generations * generation

    @property
    def individuals(self) -> int:
        """Number of individuals evaluated in all turns of a run."""
        populations = self.config.populations.values()
        return sum(p.size * (1 + self.config.run.generations * p.turns) for p in populations)

    def seed(self, index: int) -> int:
        """Return the seed of a run; it does not depend on the other cells or on the number of runs."""
        name = _identity([dict(self.settings), self.config.run.seed, index])
        return int.from_bytes(hashlib.sha256(name.encode()).digest()[:6], "little")


@attrs.frozen
class Planned:
    """A run of a study, identified by its directory.

    Attributes:
        cell: Its configuration.
        index: Number of the run within its cell, from 0.
        directory: Its directory.
    """

    cell: Cell = attrs.field(eq=False)
    index: int = attrs.field(eq=False)
    directory: Path

    @property
    def seed(self) -> int:
        """The seed of the run."""
        return self.cell.seed(self.index)

    @property
    def label(self) -> str:
        """Name in messages, such as ``aggregator=am, run 0``."""
        return f"{self.cell.label}, run {self.index}"

    def deciding(self) -> Tree:
        """Return the tables that determine its result, in the form of the run's own record."""
        config = attrs.evolve(self.cell.config, run=attrs.evolve(self.cell.config.run, seed=self.seed))
        return config.deciding()


@attrs.frozen
class Study:
    """A study, read and validated.

    Attributes:
        layers: The settings that all cells share.
        label: Name of the study: the file name without its extension.
        grid: Dotted key -> its values.
        runs: Number of runs of each cell.
        cells: All combinations of values; the last key changes fastest.
    """

    layers: Layers = attrs.field(repr=False)
    label: str
    grid: Mapping[str, tuple[Any, ...]]
    runs: int
    cells: tuple[Cell, ...] = attrs.field(repr=False)

    @property
    def headings(self) -> list[str]:
        """Column headings of the grid's keys, shortened as by :func:`~evoframe.study.names.headings`."""
        return [*headings(self.grid).values()]

    def planned(self, directory: Path) -> Iterator[Planned]:
        """Yield all runs in the order of work: the first run of every cell, then the second of every cell."""
        for index in range(self.runs):
            for cell in self.cells:
                yield Planned(cell, index, directory / cell.folder / f"{index:02}")

    def layers_of(self, planned: Planned) -> Layers:
        """Return the layers of configuration of a run."""
        return self.layers.under(
            [*_layers(planned.cell.settings), layer_of("the study", "run.seed", planned.seed)]
        )


def study_names() -> list[str]:
    """Return the names of the built-in studies."""
    entries = files("evoframe.study").joinpath("studies").iterdir()
    return sorted(entry.name.removesuffix(".toml") for entry in entries if entry.name.endswith(".toml"))


def describes_study(layers: Layers) -> bool:
    """Return whether settings, as read from a file, have the keys of a study."""
    return bool(_OWN_KEYS.keys() & layers.merged().keys())


def read_study(
    source: str | Path, overrides: Iterable[str | Layer] = (), plugins: Plugins | None = None
) -> Study:
    """Read a study and validate all of its cells.

    Args:
        source: Path of a TOML file, or the name of a built-in study.
        overrides: As for :func:`~evoframe.load_config`, including ``runs`` and ``grid``. ``grid={...}``
            replaces the whole grid; ``grid.KEY=[...]`` sets the values of one key.
        plugins: The plugins to choose from; by default the installed ones.

    Raises:
        ConfigurationError: With all faults of the first cell that has any.
    """
    read = _with_overrides(_file_of(source), overrides)
    tree = read.merged()
    if not describes_study(read):
        keys = " nor ".join(_OWN_KEYS)
        problem = f"not a study: has neither {keys}; to run this configuration once: evoframe run {source}"
        raise ConfigurationError(problem, source=source)
    for key, expected in _OWN_KEYS.items():
        if key not in tree:
            raise ConfigurationError(f"missing; expected {expected}", source=source, key=key)
    origin, runs = read.origin(("grid",)), tree["runs"]
    if isinstance(runs, bool) or not isinstance(runs, int) or runs < 1:
        raise ConfigurationError(
            f"expected a whole number >= 1, found {found(runs)}", source=read.origin(("runs",)), key="runs"
        )
    grid = _grid(tree["grid"], origin)
    size = runs * math.prod(len(values) for values in grid.values())
    if size > _MOST_RUNS:
        raise ConfigurationError(
            f"the study has {size} runs, expected at most {_MOST_RUNS}; reduce runs or the grid",
            source=origin,
        )
    layers, label, plugins = read.without(*_OWN_KEYS), Path(source).stem, plugins or discover()
    cells = []
    for values in itertools.product(*grid.values()):
        settings = tuple(zip(grid, values, strict=True))
        cells.append(
            Cell(settings, resolve_layers(layers.under(_layers(settings, f"{origin}: ")), label, plugins))
        )
    return Study(layers, label, grid, runs, tuple(cells))


def _with_overrides(source: str | Path, overrides: Iterable[str | Layer]) -> Layers:
    """Read a study's file and apply the overrides; the last whole grid among them replaces all before it."""
    given = overrides if isinstance(overrides, str) else list(overrides)  # a string is refused below
    places = [place for place, override in enumerate(given) if _is_whole_grid(override)]
    if not places:
        return read_layers(source, given)
    return read_layers(source, given[: places[-1]]).without("grid").under(given[places[-1] :])


def _is_whole_grid(override: str | Layer) -> bool:
    """Return whether an override is ``grid={...}``, and not ``grid.KEY=[...]``."""
    text = override.origin if isinstance(override, Layer) else override
    return text.partition("=")[0].strip() == "grid"


def _file_of(source: str | Path) -> str | Path:
    if source in study_names():
        with_path: Any = files("evoframe.study").joinpath("studies", f"{source}.toml")
        return str(with_path)
    if not exists(Path(source)):
        hint = suggestion(str(source), study_names(), "studies")
        raise ConfigurationError(f"no such study or file{hint}", source=source)
    return source


def _grid(table: Any, origin: str) -> dict[str, tuple[Any, ...]]:
    """Return the grid; a quoted dotted key is equivalent to nested tables."""
    axes = list(_axes(table, (), origin))
    grid = dict(axes)
    for one, other in itertools.combinations(sorted(key for key, _ in axes), 2):
        if other.startswith(f"{one}."):
            raise ConfigurationError(
                f"the grid also has '{one}', which includes this key; remove one of them",
                source=origin,
                key=f"grid.{other}",
            )
    for key, values in grid.items():
        if key == "run.seed":
            raise ConfigurationError(
                "seeds are derived from the study; set the number of runs instead, as in runs = 10",
                source=origin,
                key="grid.run.seed",
            )
        if key == "run":  # may set the seed too
            raise ConfigurationError(
                "'run' is a column of rows.csv; vary a setting of the table, as in "
                "run.generations = [100, 200]",
                source=origin,
                key="grid.run",
            )
        texts = [shown(value) for value in values]
        if not values or len(set(texts)) < len(texts):
            raise ConfigurationError(
                f"expected one or more different values, found {found(list(values))}",
                source=origin,
                key=f"grid.{key}",
            )
    return grid


def _axes(table: Any, path: tuple[str, ...], origin: str) -> Iterator[tuple[str, tuple[Any, ...]]]:
    if not isinstance(table, Mapping):
        where = ".".join(("grid", *path))
        raise ConfigurationError(f"expected a list of values, found {found(table)}", source=origin, key=where)
    for key, value in table.items():
        dotted = ".".join((*path, key))
        if not _KEY.fullmatch(dotted):
            raise ConfigurationError(
                "is not a key of a configuration; expected one such as collaboration.n",
                source=origin,
                key=f"grid.{dotted}",
            )
        if isinstance(value, list):
            yield dotted, tuple(value)
        else:
            yield from _axes(value, (*path, key), origin)


def _layers(settings: Settings, where: str = "") -> list[Layer]:
    return [layer_of(f"{where}grid: {key}={shown(value)}", key, value) for key, value in settings]


def shown(value: Any) -> str:
    """Return a value of the grid as text; no two values of a key may have the same text."""
    return value if isinstance(value, str) else _identity(value)


def _identity(value: Any) -> str:
    return json.dumps(value, sort_keys=True, default=str)


def _plain(value: Any) -> str:
    """Return a value as the name of a folder, unique for each value."""
    text = shown(value)
    if _PLAIN.fullmatch(text):
        return text
    name = value.get("name", "") if isinstance(value, Mapping) else ""
    digest = hashlib.sha256(_identity(value).encode()).hexdigest()[:8]
    return f"{name}-{digest}" if isinstance(name, str) and _PLAIN.fullmatch(name) else digest
