"""Sources of designs to simulate, verify or export: files with designs, and runs."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeAlias

import attrs

from evoframe.config import (
    Layer,
    Layers,
    layers_in,
    named_simulator,
    read_layers,
    resolve_layers,
    resolve_simulator,
)
from evoframe.contract import (
    Design,
    FileContents,
    FileOptions,
    RunConfig,
    Simulator,
    SupportsDialects,
    SupportsObjective,
    SupportsReading,
    SupportsSettings,
    blaming,
)
from evoframe.documents import Tree
from evoframe.errors import ConfigurationError, InputError
from evoframe.files import is_directory
from evoframe.record import CONFIG_FILE, Run, open_run, read_champion
from evoframe.registry import Plugins

__all__ = ["DEFAULT_PRESET", "Job", "naming", "read_job"]

DEFAULT_PRESET = "paper"
"""The preset that provides the settings that a file lacks."""

Overrides: TypeAlias = Sequence[str | Layer]


@attrs.frozen
class Job:
    """The designs of one file or run, and the configuration with which they are simulated.

    Attributes:
        path: The file, or the run's directory.
        config: The configuration that simulates and scores them.
        labels: A label for each design, shown to the user.
        designs: The designs, in the order of the labels.
        run: The run, if the source is a run.
        score: Its score in the run, if the design is a champion simulated as in its run.
        unscored: Reason why the simulations lack the samples that the objective requires, so that the designs
            have no scores; empty if they have.
        dialect: Name of the program by whose rules the file was read; empty if there is no choice.
        notes: What a user should know about the reading of the file, a line each.
    """

    path: Path
    config: RunConfig
    labels: tuple[str, ...]
    designs: tuple[Design, ...]
    run: Run | None = None
    score: float | None = None
    unscored: str = ""
    dialect: str = ""
    notes: tuple[str, ...] = ()


def read_job(  # noqa: PLR0913 - the choices of a user
    source: Path | Run,
    preset: Layers | None,
    overrides: Overrides,
    plugins: Plugins,
    *,
    scored: bool = True,
    options: FileOptions | None = None,
) -> Job:
    """Read the designs of a source, and determine the configuration with which they are simulated.

    A run or its ``champion.json`` is simulated as in the run, unless *preset* is given. All other files are
    read by the simulator, which returns their designs and settings; these settings override the preset
    (default: ``paper``). *overrides* have the highest precedence.

    A file with settings of its own is not an experiment of the default preset, so it is not scored by the
    objective of that preset, but by the one that the simulator suggests (:class:`SupportsObjective`), unless
    *preset* is given or *overrides* name an objective.

    Args:
        source: A run or its directory, for its champion; a ``champion.json``; or a file in a format that
            the simulator reads.
        preset: The settings of a preset or TOML file.
        overrides: ``key=value``, or layers, as for :func:`~evoframe.load_config`.
        plugins: The available plugins.
        scored: Whether the designs must be scored. If not, simulations may lack the samples that the
            objective requires, unless *overrides* set the objective; :attr:`Job.unscored` has the reason.
        options: Choices for reading a file; their settings are those of *overrides*.

    Raises:
        InputError: The file cannot be read, or has an unexpected content.
        ConfigurationError: The configuration is invalid, or does not fit the designs.
    """
    scored = scored or "objective" in _tree(overrides)
    reader = _Reader(preset, overrides, plugins, scored, options or FileOptions())
    if isinstance(source, Run):
        return reader.of_run(source)
    if is_directory(source):
        with open_run(source) as run:
            return reader.of_run(run)
    return reader.of_champion(source) if source.suffix == ".json" else reader.of_file(source)


@contextlib.contextmanager
def naming(path: Path) -> Iterator[None]:
    """Name *path* as the source of errors raised by a component that knows only the content of the file."""
    try:
        yield
    except (ConfigurationError, InputError) as error:
        error.source = error.source or str(path)
        raise


@attrs.frozen
class _Reader:
    """Reader of one source; the fields are the arguments of :func:`read_job`."""

    preset: Layers | None
    overrides: Overrides
    plugins: Plugins
    scored: bool
    options: FileOptions

    def of_run(self, run: Run) -> Job:
        self._refuse_options(run.directory)
        champion, path = run.champion(), run.directory
        own = self.preset or layers_in(run.config, str(path / CONFIG_FILE))
        job = self._job(path, own, [(str(path), champion.design)])
        return attrs.evolve(_checked(job), run=run, score=self._score(champion.score, own))

    def of_champion(self, path: Path) -> Job:
        self._refuse_options(path)
        champion = read_champion(path)
        own = self._base()
        if self.preset is None:
            own = own.under([Layer(str(path), champion.simulation)])
        job = self._job(path, own, [(path.name, champion.design)])
        return attrs.evolve(_checked(job), score=self._score(champion.score, own))

    def of_file(self, path: Path) -> Job:
        base = self._base()
        settings, contents = self._contents(path, base)
        own = base.under(settings)
        chosen = resolve_simulator(own.under(self.overrides), self.plugins)
        if chosen is None or not isinstance(chosen.component, SupportsReading):
            config = self._config(own)  # faults of the settings come first
            problem = f"'{config.simulator.name}' cannot read files with designs"
            raise ConfigurationError(problem, source=path, key="simulator")
        labelled = contents.designs if contents else chosen.component.read(path)
        if settings and self.preset is None and not _names_objective(self.overrides):
            own = own.under(_suggested(path, chosen.component, [design for _, design in labelled]))
        job = self._job(path, own, labelled)
        return attrs.evolve(job, dialect=contents.dialect, notes=contents.notes) if contents else job

    def _base(self) -> Layers:
        return self.preset or read_layers(DEFAULT_PRESET)

    def _contents(self, path: Path, base: Layers) -> tuple[list[Layer], FileContents | None]:
        """Return the settings in a file as a layer, if it has any, and its contents, if it has dialects."""
        simulator = named_simulator(base, self.overrides, self.plugins)
        component = None if simulator is None else simulator.component
        settings, contents = None, None
        if isinstance(component, SupportsDialects):
            options = attrs.evolve(self.options, settings=_options_of_simulator(self.overrides))
            contents = component.interpret(path, options)
            settings = contents.settings if contents else None
        elif isinstance(component, SupportsSettings):
            settings = component.settings_of(path)
        if contents is None:
            self._refuse_options(path)
        if simulator is None or settings is None:
            return [], contents
        return [Layer(str(path), {"simulator": {"name": simulator.name, **settings}})], contents

    def _refuse_options(self, path: Path) -> None:
        """Refuse options for reading files with dialects if a source is none of them.

        Raises:
            ConfigurationError: There is such an option.
        """
        for given, name in ((self.options.dialect, "--dialect"), (self.options.base, "--base")):
            if given:
                problem = f"{path} is read in one way only; {name} is for files of other programs"
                raise ConfigurationError(problem, source=name)

    def _job(self, path: Path, own: Layers, labelled: Sequence[tuple[str, Design]]) -> Job:
        config = self._config(own)
        labels, designs = zip(*labelled, strict=True)
        return Job(path, config, labels, designs, unscored="" if self.scored else _unscored(config))

    def _config(self, own: Layers) -> RunConfig:
        layers, label = own.under(self.overrides), Path(own.source).stem
        return resolve_layers(layers, label, self.plugins, scored=self.scored)

    def _score(self, score: float, own: Layers) -> float | None:
        """Return the score of a champion in its run, if it is simulated and scored as there."""
        return score if self.preset is None and _changes_nothing(own, self.overrides) else None


def _tree(overrides: Overrides) -> Tree:
    return Layers(()).under(overrides).merged()


def _names_objective(overrides: Overrides) -> bool:
    """Return whether *overrides* choose an objective, not only set options of the one chosen otherwise."""
    table = _tree(overrides).get("objective")
    return table is not None and not (isinstance(table, Mapping) and "name" not in table)


def _options_of_simulator(overrides: Overrides) -> dict[str, Any]:
    """Return the options of the simulator that *overrides* set."""
    table = _tree(overrides).get("simulator")
    return {key: value for key, value in table.items() if key != "name"} if isinstance(table, Mapping) else {}


def _suggested(path: Path, simulator: Simulator, designs: Sequence[Design]) -> list[Layer]:
    """Return the objective that a simulator suggests as a layer, if it suggests any."""
    if not isinstance(simulator, SupportsObjective):
        return []
    with naming(path), blaming("simulator"):
        return [Layer(str(path), {"objective": dict(simulator.objective_for(designs))})]


def _unscored(config: RunConfig) -> str:
    """Return why simulations lack samples of the objective; empty if they have all."""
    try:
        config.simulator.component.check(config.objective.component.record)
    except ConfigurationError as error:
        return error.problem
    return ""


def _checked(job: Job) -> Job:
    """Return the job of a champion, which must have the roles that the simulator requires."""
    [design], required = job.designs, job.config.simulator.component.requires
    missing = [role for role in required if role not in design.roles]
    if missing:
        raise InputError(f"missing {' and '.join(missing)}", source=job.path, key="design")
    return job


def _changes_nothing(own: Layers, overrides: Overrides) -> bool:
    """Return ``True`` if *overrides* change neither simulator nor objective."""
    alone, together = own.merged(), own.under(overrides).merged()
    return all(alone.get(key) == together.get(key) for key in ("simulator", "objective"))
