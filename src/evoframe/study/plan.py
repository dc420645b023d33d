"""What a study consists of: its cells, the seeds of its runs, and where each of them lies."""

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
from evoframe.contract import RunConfig, unit_of
from evoframe.documents import Tree
from evoframe.errors import ConfigurationError
from evoframe.evolution import first_meetings
from evoframe.messages import found, suggestion
from evoframe.registry import Plugins, discover
from evoframe.study.names import headings

__all__ = ["Cell", "Planned", "Study", "read_study", "shown", "study_names"]

Settings: TypeAlias = tuple[tuple[str, Any], ...]
"""Dotted key and value, in the order of the grid."""

_KEY = re.compile(r"[a-z0-9_-]+(\.[a-z0-9_-]+)*")
_PLAIN = re.compile(r"[A-Za-z0-9][A-Za-z0-9._+-]{0,60}")
_OWN_KEYS = {
    "runs": "how often each configuration is run",
    "grid": "a table of keys, each with a list of values",
}
_MOST_RUNS = 1_000_000


@attrs.frozen(eq=False)
class Cell:
    """One configuration of a study.

    Attributes:
        settings: What distinguishes it from the others.
        config: All of it; the seed is that of the study.
    """

    settings: Settings
    config: RunConfig = attrs.field(repr=False)

    @property
    def label(self) -> str:
        """What a person calls it: ``aggregator=am, collaboration.n=2``."""
        return ", ".join(f"{key}={shown(value)}" for key, value in self.settings) or "all"

    @property
    def unit(self) -> str:
        """Unit of the scores; empty if the objective does not state one."""
        return unit_of(self.config.objective.component)

    @property
    def values(self) -> list[str]:
        """What distinguishes it, as text, in the order of the grid."""
        return [shown(value) for _, value in self.settings]

    @property
    def folder(self) -> Path:
        """Where its runs lie in the directory of the study: a level for each key."""
        return Path(*(f"{key}={_plain(value)}" for key, value in self.settings))

    @functools.cached_property
    def pairs(self) -> int:
        """How many pairs a run scores, repeats included, the meeting at the end apart."""
        sizes = [population.size for population in self.config.populations.values()]
        strategy = self.config.collaboration.component
        generation = 0
        for index, size in enumerate(sizes):
            # Several other populations give the same number of collaborators: a configuration is checked.
            [teams] = {strategy.size(other) for i, other in enumerate(sizes) if i != index}
            generation += size * teams
        return len(first_meetings(sizes)) + self.config.run.generations * generation

    def seed(self, index: int) -> int:
        """Return the seed of one of its runs, which depends on nothing else in the study."""
        name = _identity([dict(self.settings), self.config.run.seed, index])
        return int.from_bytes(hashlib.sha256(name.encode()).digest()[:6], "little")


@attrs.frozen
class Planned:
    """One run of a study, known by its directory.

    Attributes:
        cell: Its configuration.
        index: Which of the runs of its cell, from 0 up.
        directory: Where it lies.
    """

    cell: Cell = attrs.field(eq=False)
    index: int = attrs.field(eq=False)
    directory: Path

    @property
    def seed(self) -> int:
        """Its seed."""
        return self.cell.seed(self.index)

    @property
    def label(self) -> str:
        """What a person calls it."""
        return f"{self.cell.label}, run {self.index}"

    def deciding(self) -> Tree:
        """Return the tables on which its result depends, as its own record has them."""
        config = attrs.evolve(self.cell.config, run=attrs.evolve(self.cell.config.run, seed=self.seed))
        return config.deciding()


@attrs.frozen
class Study:
    """A study that was read and checked.

    Attributes:
        layers: The settings that all cells share.
        label: What a person calls it.
        grid: Dotted key -> the values that it takes.
        runs: How often each cell is run.
        cells: All combinations, the last key changing fastest.
    """

    layers: Layers = attrs.field(repr=False)
    label: str
    grid: Mapping[str, tuple[Any, ...]]
    runs: int
    cells: tuple[Cell, ...] = attrs.field(repr=False)

    @property
    def headings(self) -> list[str]:
        """What a table calls the keys of the grid: the last part of each, where that is enough."""
        return [*headings(self.grid).values()]

    def planned(self, directory: Path) -> Iterator[Planned]:
        """Yield all runs in the order of work: the first of every cell, then the second of every cell."""
        for index in range(self.runs):
            for cell in self.cells:
                yield Planned(cell, index, directory / cell.folder / f"{index:02}")

    def layers_of(self, planned: Planned) -> Layers:
        """Return the configuration of one run, as it is resolved."""
        return self.layers.under(
            [*_layers(planned.cell.settings), layer_of("the study", "run.seed", planned.seed)]
        )


def study_names() -> list[str]:
    """Return the names of the studies that come with evoframe."""
    entries = files("evoframe.study").joinpath("studies").iterdir()
    return sorted(entry.name.removesuffix(".toml") for entry in entries if entry.name.endswith(".toml"))


def read_study(
    source: str | Path, overrides: Iterable[str | Layer] = (), plugins: Plugins | None = None
) -> Study:
    """Read and check a study, all of its cells.

    Args:
        source: Path of a TOML file, or the name of a study that comes with evoframe.
        overrides: As for :func:`~evoframe.load_config`; ``runs`` and ``grid`` can be set too.
        plugins: The plugins to choose from; by default those that are installed.

    Raises:
        ConfigurationError: With all faults of the first cell that has any.
    """
    read = read_layers(_file_of(source), overrides)
    tree = read.merged()
    for key, what in _OWN_KEYS.items():
        if key not in tree:
            raise ConfigurationError(f"{source}: {key}: is missing: {what}")
    origin, runs = read.origin(("grid",)), tree["runs"]
    if isinstance(runs, bool) or not isinstance(runs, int) or runs < 1:
        where, expected = read.origin(("runs",)), "expected a whole number from 1 up"
        raise ConfigurationError(f"{where}: runs: {expected}, found {found(runs)}")
    grid = _grid(tree["grid"], origin)
    size = runs * math.prod(len(values) for values in grid.values())
    if size > _MOST_RUNS:
        raise ConfigurationError(f"{origin}: a study of {size} runs; at most {_MOST_RUNS}")
    layers, label, plugins = read.without(*_OWN_KEYS), Path(source).stem, plugins or discover()
    cells = []
    for values in itertools.product(*grid.values()):
        settings = tuple(zip(grid, values, strict=True))
        cells.append(
            Cell(settings, resolve_layers(layers.under(_layers(settings, f"{origin}: ")), label, plugins))
        )
    return Study(layers, label, grid, runs, tuple(cells))


def _file_of(source: str | Path) -> str | Path:
    if source in study_names():
        with_path: Any = files("evoframe.study").joinpath("studies", f"{source}.toml")
        return str(with_path)
    if not str(source).endswith(".toml") and not Path(source).exists():
        known = study_names()
        raise ConfigurationError(
            f"there is no study '{source}'{suggestion(str(source), known, 'studies')}; "
            "a file needs the ending .toml"
        )
    return source


def _grid(table: Any, origin: str) -> dict[str, tuple[Any, ...]]:
    """Return the grid; a quoted dotted key and a table within a table mean the same."""
    axes = list(_axes(table, (), origin))
    grid = dict(axes)
    for one, other in itertools.combinations(sorted(key for key, _ in axes), 2):
        if other.startswith(f"{one}."):
            raise ConfigurationError(f"{origin}: grid: {other}: is a part of {one}, which is there too")
    for key, values in grid.items():
        if key == "run.seed":
            raise ConfigurationError(f"{origin}: grid: run.seed: seeds are derived; say with runs how many")
        if key == "run":  # may set the seed too
            raise ConfigurationError(
                f"{origin}: grid: run: is a column of the study's tables already; give its settings one by "
                "one, as in run.generations = [100, 200]"
            )
        texts = [shown(value) for value in values]
        if not values or len(set(texts)) < len(texts):
            raise ConfigurationError(
                f"{origin}: grid.{key}: expected different values, found {found(list(values))}"
            )
    return grid


def _axes(table: Any, path: tuple[str, ...], origin: str) -> Iterator[tuple[str, tuple[Any, ...]]]:
    if not isinstance(table, Mapping):
        where = ".".join(("grid", *path))
        raise ConfigurationError(f"{origin}: {where}: expected a list of values, found {found(table)}")
    for key, value in table.items():
        dotted = ".".join((*path, key))
        if not _KEY.fullmatch(dotted):
            raise ConfigurationError(f"{origin}: grid: '{dotted}' is no key of a configuration")
        if isinstance(value, list):
            yield dotted, tuple(value)
        else:
            yield from _axes(value, (*path, key), origin)


def _layers(settings: Settings, where: str = "") -> list[Layer]:
    return [layer_of(f"{where}grid: {key}={shown(value)}", key, value) for key, value in settings]


def shown(value: Any) -> str:
    """Return a value of the grid as text: another for each value of a key, or the grid is refused."""
    return value if isinstance(value, str) else _identity(value)


def _identity(value: Any) -> str:
    return json.dumps(value, sort_keys=True, default=str)


def _plain(value: Any) -> str:
    """Return a value as the name of a folder, the same for the same value only."""
    text = shown(value)
    if _PLAIN.fullmatch(text):
        return text
    name = value.get("name", "") if isinstance(value, Mapping) else ""
    digest = hashlib.sha256(_identity(value).encode()).hexdigest()[:8]
    return f"{name}-{digest}" if isinstance(name, str) and _PLAIN.fullmatch(name) else digest
