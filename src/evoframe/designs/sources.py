"""Sources of designs to simulate, verify or export: files with designs, and runs."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Sequence
from pathlib import Path

import attrs

from evoframe.config import (
    Layer,
    Layers,
    layers_in,
    load_config,
    named_simulator,
    read_layers,
    resolve_layers,
)
from evoframe.contract import Design, RunConfig, SupportsReading, SupportsSettings
from evoframe.errors import ConfigurationError, InputError
from evoframe.files import is_directory
from evoframe.record import CONFIG_FILE, Run, open_run, read_champion
from evoframe.registry import Plugins

__all__ = ["DEFAULT_PRESET", "Job", "naming", "read_job"]

DEFAULT_PRESET = "paper"
"""The preset that provides the settings that a file lacks."""


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
    """

    path: Path
    config: RunConfig
    labels: tuple[str, ...]
    designs: tuple[Design, ...]
    run: Run | None = None
    score: float | None = None


def read_job(
    source: Path | Run,
    preset: str | None,
    overrides: Sequence[str | Layer],
    plugins: Plugins,
) -> Job:
    """Read the designs of a source, and determine the configuration with which they are simulated.

    A run or its ``champion.json`` is simulated as in the run, unless *preset* is given. All other files are
    read by the simulator, which returns their designs and settings; these settings override the preset
    (default: ``paper``). *overrides* have the highest precedence.

    Args:
        source: A run or its directory, for its champion; a ``champion.json``; or a file in a format that
            the simulator reads.
        preset: Name of a preset, or path of a TOML file.
        overrides: ``key=value``, or layers, as for :func:`~evoframe.load_config`.
        plugins: The available plugins.

    Raises:
        InputError: The file cannot be read, or has an unexpected content.
        ConfigurationError: The configuration is invalid, or does not fit the designs.
    """
    if isinstance(source, Run):
        return _of_run(source, preset, overrides, plugins)
    if is_directory(source):
        with open_run(source) as run:
            return _of_run(run, preset, overrides, plugins)
    read = _of_champion if source.suffix == ".json" else _of_file
    return read(source, preset, overrides, plugins)


@contextlib.contextmanager
def naming(path: Path) -> Iterator[None]:
    """Name *path* as the source of errors raised by a component that knows only the content of the file."""
    try:
        yield
    except (ConfigurationError, InputError) as error:
        error.source = error.source or str(path)
        raise


def _of_run(run: Run, preset: str | None, overrides: Sequence[str | Layer], plugins: Plugins) -> Job:
    champion, path = run.champion(), run.directory
    own = read_layers(preset) if preset else layers_in(run.config, str(path / CONFIG_FILE))
    config = resolve_layers(own.under(overrides), Path(preset or CONFIG_FILE).stem, plugins)
    _check_roles(path, champion.design, config)
    score = champion.score if preset is None and _changes_nothing(own, overrides) else None
    return Job(path, config, (str(path),), (champion.design,), run, score)


def _of_champion(path: Path, preset: str | None, overrides: Sequence[str | Layer], plugins: Plugins) -> Job:
    champion = read_champion(path)
    own = (
        read_layers(preset)
        if preset
        else read_layers(DEFAULT_PRESET, [Layer(str(path), champion.simulation)])
    )
    config = resolve_layers(own.under(overrides), Path(preset or DEFAULT_PRESET).stem, plugins)
    _check_roles(path, champion.design, config)
    score = champion.score if preset is None and _changes_nothing(own, overrides) else None
    return Job(path, config, (path.name,), (champion.design,), score=score)


def _of_file(path: Path, preset: str | None, overrides: Sequence[str | Layer], plugins: Plugins) -> Job:
    source = preset or DEFAULT_PRESET
    own = _settings_of(path, source, overrides, plugins)
    config = load_config(source, overrides=[*own, *overrides], plugins=plugins)
    simulator = config.simulator.component
    if not isinstance(simulator, SupportsReading):
        problem = f"'{config.simulator.name}' cannot read files with designs"
        raise ConfigurationError(problem, source=path, key="simulator")
    labels, designs = zip(*simulator.read(path), strict=True)
    return Job(path, config, labels, designs)


def _settings_of(path: Path, source: str, overrides: Sequence[str | Layer], plugins: Plugins) -> list[Layer]:
    """Return the settings in a file as a layer, if it has any."""
    simulator = named_simulator(source, overrides, plugins)
    if simulator is None or not isinstance(simulator.component, SupportsSettings):
        return []
    settings = simulator.component.settings_of(path)
    return [] if settings is None else [Layer(str(path), {"simulator": {"name": simulator.name, **settings}})]


def _check_roles(path: Path, design: Design, config: RunConfig) -> None:
    missing = [role for role in config.simulator.component.requires if role not in design.roles]
    if missing:
        raise InputError(f"missing {' and '.join(missing)}", source=path, key="design")


def _changes_nothing(own: Layers, overrides: Sequence[str | Layer]) -> bool:
    """Return ``True`` if *overrides* change neither simulator nor objective."""
    alone, together = own.merged(), own.under(overrides).merged()
    return all(alone.get(key) == together.get(key) for key in ("simulator", "objective"))
