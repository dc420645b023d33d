"""What a person names to have it simulated, verified or exported: files with designs, and runs."""

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
"""With which designs are simulated that do not say how."""


@attrs.frozen
class Job:
    """The designs of one file or run, and the configuration that they are simulated with.

    Attributes:
        path: The file, or the run's directory.
        config: What simulates and scores them.
        labels: What a person calls each design.
        designs: One for each label.
        run: The run, if its directory was named.
        score: What the design scored in its run, if it is a champion that is simulated as it was there.
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
    *,
    runs: bool = False,
) -> Job:
    """Read the designs of a source, and decide how they are simulated.

    A run and its ``champion.json`` are simulated as in the run, unless a *preset* is named. Of all other
    files the simulator says what they hold, and which settings they bring with them; these override the
    preset's, which is ``paper`` if none is named. *overrides* come last.

    Args:
        source: A run, which stands for its champion, or its directory; a ``champion.json``, or a file that
            the simulator reads.
        preset: Name of a preset, or path of a TOML file.
        overrides: ``key=value``, or layers, as for :func:`~evoframe.load_config`.
        plugins: The plugins to choose from.
        runs: Whether the directory of a run is accepted.

    Raises:
        InputError: The file cannot be read, or is something else.
        ConfigurationError: It cannot be simulated like this.
    """
    if isinstance(source, Run):
        return _of_run(source, preset, overrides, plugins)
    if is_directory(source):
        if not runs:
            raise InputError(f"{source}: cannot be read: Is a directory; that of a run has a champion.json")
        with open_run(source) as run:
            return _of_run(run, preset, overrides, plugins)
    read = _of_champion if source.suffix == ".json" else _of_file
    return read(source, preset, overrides, plugins)


@contextlib.contextmanager
def naming(path: Path) -> Iterator[None]:
    """Put the file in front of what a component says that knows only its content."""
    try:
        yield
    except (ConfigurationError, InputError) as error:
        raise type(error)(f"{path}: {error}") from error


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
        raise ConfigurationError(f"the simulator '{config.simulator.name}' reads no files")
    labels, designs = zip(*simulator.read(path), strict=True)
    return Job(path, config, labels, designs)


def _settings_of(path: Path, source: str, overrides: Sequence[str | Layer], plugins: Plugins) -> list[Layer]:
    """Return the layer of settings that a file brings with it, if it brings any."""
    simulator = named_simulator(source, overrides, plugins)
    if simulator is None or not isinstance(simulator.component, SupportsSettings):
        return []
    settings = simulator.component.settings_of(path)
    return [] if settings is None else [Layer(str(path), {"simulator": {"name": simulator.name, **settings}})]


def _check_roles(path: Path, design: Design, config: RunConfig) -> None:
    missing = [role for role in config.simulator.component.requires if role not in design.roles]
    if missing:
        raise InputError(f"{path}: design: has no {' and no '.join(missing)}")


def _changes_nothing(own: Layers, overrides: Sequence[str | Layer]) -> bool:
    """Return whether *overrides* leave simulation and scoring as they are."""
    alone, together = own.merged(), own.under(overrides).merged()
    return all(alone.get(key) == together.get(key) for key in ("simulator", "objective"))
