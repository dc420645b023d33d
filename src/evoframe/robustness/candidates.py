"""Selection of the bodies that are measured together, from runs, studies, files and published bodies."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import attrs

from evoframe.config import Layer, Layers, complete_config, read_layers
from evoframe.contract import FileOptions, RunConfig, SupportsPublished, SupportsRandomControllers, blaming
from evoframe.designs import DEFAULT_PRESET, Job, read_job
from evoframe.documents import differences
from evoframe.errors import ConfigurationError, InputError
from evoframe.files import encodable, shown_name
from evoframe.registry import Plugins
from evoframe.robustness.measurement import Candidate
from evoframe.study import STUDY_FILE, Planned, is_study, name_of, read_study, shown, survey

__all__ = ["Candidates", "Part", "champions", "read_candidates"]


@attrs.frozen(eq=False)
class Candidates:
    """Bodies that can be measured together.

    Attributes:
        config: Configuration of simulator, objective and executor.
        bodies: One or more bodies on the same canvas, with different names.
        notes: Files, with what a user should know about their reading.
    """

    config: RunConfig
    bodies: tuple[Candidate, ...]
    notes: tuple[tuple[Path, tuple[str, ...]], ...] = ()


@attrs.frozen(eq=False)
class Part:
    """The bodies of one file or run.

    Attributes:
        named: The source as given by the user.
        config: Configuration that simulates them.
        bodies: One or more bodies.
        notes: What a user should know about the reading of a file.
    """

    named: str
    config: RunConfig
    bodies: tuple[Candidate, ...]
    notes: tuple[str, ...] = ()


def read_candidates(  # noqa: PLR0913 - the choices of a user
    sources: Sequence[Path],
    preset: Layers | None,
    overrides: Sequence[str | Layer],
    plugins: Plugins,
    *,
    published: bool = False,
    options: FileOptions | None = None,
) -> Candidates:
    """Read the bodies of all sources, and check that they can be compared.

    A study provides the champions of its finished runs, with a group for each configuration. A run or file is
    read as by :func:`~evoframe.designs.sources.read_job`, and each of its bodies is a group.

    Args:
        sources: Directories of studies and runs, and files with designs.
        preset: The settings of a preset or TOML file, with which all bodies are simulated.
        overrides: Overrides for all bodies, as ``key=value`` or layers.
        plugins: The plugins to choose from.
        published: Whether to add the published bodies of the simulator. They are simulated like the first
            source or, without sources, with the preset (by default ``paper``).
        options: Choices for reading files.

    Raises:
        InputError: A source cannot be read, or the bodies cannot be compared.
        ConfigurationError: The bodies cannot be simulated with these settings.
    """
    studies = [path for path in sources if is_study(path)]
    alike = len({shown_name(path) for path in studies}) < len(studies)
    names = {path: _text(path) if alike else shown_name(path) for path in studies} if len(studies) > 1 else {}
    reader = _Reader(preset, overrides, plugins, names, options or FileOptions())
    parts = [part for path in sources for part in _some(reader, path)]
    notes = tuple((Path(part.named), part.notes) for part in parts if part.notes)
    if published:
        base = preset or read_layers(DEFAULT_PRESET)
        config = parts[0].config if parts else complete_config(base, overrides, plugins)
        parts.append(_published(config))
    bodies = tuple(body for part in parts for body in part.bodies)
    if not bodies:
        raise InputError("no body to measure; name runs, studies or files, or add --published")
    _refuse_other_simulations(parts)
    _refuse_same_names(parts)
    config = parts[0].config
    if not isinstance(config.simulator.component, SupportsRandomControllers):
        raise ConfigurationError(
            f"the simulator '{config.simulator.name}' does not draw random controllers, which robustness "
            "requires; choose another, as in --set simulator=vox"
        )
    _refuse_missing_roles(bodies, config.simulator.component.requires)
    _refuse_other_canvases(bodies, config.simulator.component.requires)
    return Candidates(config, bodies, notes)


def champions(directory: Path, plugins: Plugins) -> Iterator[Part]:
    """Yield the champion of a run, or the champions of a study's finished runs.

    Args:
        directory: Directory of the run or study.
        plugins: The plugins to choose from.

    Raises:
        InputError: A run is damaged.
        ConfigurationError: A champion cannot be simulated with these plugins.
    """
    return _Reader(None, (), plugins, {}, FileOptions()).parts(directory)


@attrs.frozen
class _Reader:
    """Reader of one source after another; *studies* has the names of studies if there are several."""

    preset: Layers | None
    overrides: Sequence[str | Layer]
    plugins: Plugins
    studies: Mapping[Path, str]
    options: FileOptions

    def parts(self, path: Path) -> Iterator[Part]:
        if is_study(path):
            yield from self._of_study(path)
        else:
            yield _of_job(self._job(path))

    def _job(self, path: Path, own: Sequence[Layer] = ()) -> Job:
        return read_job(path, self.preset, [*own, *self.overrides], self.plugins, options=self.options)

    def _of_study(self, path: Path) -> Iterator[Part]:
        study = read_study(path / STUDY_FILE, (), self.plugins)
        statuses = survey(study, path)
        finished = [planned for planned, status in statuses.items() if status.state == "finished"]
        for planned in sorted(finished, key=lambda planned: study.cells.index(planned.cell)):
            directory, own = planned.directory, [] if self.preset else [_executor(planned)]
            job = self._job(directory, own)
            label = _text(directory)
            body = Candidate(label, self._group(planned, path), job.designs[0], label)
            yield Part(_text(path), job.config, (body,))

    def _group(self, planned: Planned, path: Path) -> str:
        name = name_of({key: shown(value) for key, value in planned.cell.settings})
        if not name:
            return _text(path)
        return f"{self.studies[path]}: {name}" if path in self.studies else name


def _some(reader: _Reader, path: Path) -> list[Part]:
    """Return the parts of a source, one or more."""
    found = list(reader.parts(path))
    if not found:
        raise InputError("no run of this study is finished, so it has no champions", source=path)
    return found


def _executor(planned: Planned) -> Layer:
    """Return the layer with the study's executor, since each of its runs has only one worker."""
    return Layer("the study", {"executor": planned.cell.config.tables()["executor"]})


def _of_job(job: Job) -> Part:
    """Return the bodies of a run or file, each in its own group; labels equal to its name become its path."""
    named = _text(job.path)
    labels = [named if label in (job.path.name, str(job.path)) else label for label in job.labels]
    bodies = [
        Candidate(label, label, design, named, job.dialect)
        for label, design in zip(labels, job.designs, strict=True)
    ]
    return Part(named, job.config, tuple(bodies), job.notes)


def _text(path: Path) -> str:
    """Return a path as text for files; bytes that are not UTF-8 are replaced."""
    return encodable(str(path))


def _published(config: RunConfig) -> Part:
    simulator = config.simulator.component
    if not isinstance(simulator, SupportsPublished):
        raise ConfigurationError(
            f"the simulator '{config.simulator.name}' has no published bodies; remove --published"
        )
    named = f"published with {config.simulator.name}"
    with blaming("simulator"):
        bodies = [Candidate(label, label, design, named) for label, design in simulator.published()]
    return Part(named, config, tuple(bodies))


def _refuse_other_simulations(parts: Sequence[Part]) -> None:
    first, *others = parts
    for part in others:
        one, other = first.bodies[0].source, part.bodies[0].source
        words = (f"in {one}", f"in {other}")
        lines = differences(first.config.simulation(), part.config.simulation(), words)
        if lines:
            listed = "\n  ".join(lines)
            raise InputError(
                f"simulation differs from that of {one}; choose one preset for all (--preset), or set these "
                f"keys (--set):\n  {listed}",
                source=other,
            )


def _refuse_same_names(parts: Sequence[Part]) -> None:
    owners: dict[str, str] = {}
    labels: set[str] = set()
    for part in parts:
        for body in part.bodies:
            owner = owners.setdefault(body.group, part.named)
            if owner != part.named or body.label in labels:
                raise InputError(
                    f"'{body.group}' already names a body or group of {owner}; name each source once, and if "
                    "two sources differ, name one of them by another path",
                    source=part.named,
                )
            labels.add(body.label)


def _refuse_missing_roles(bodies: Sequence[Candidate], roles: Sequence[str]) -> None:
    for body in bodies:
        missing = [role for role in roles if role not in body.design.roles]
        if missing:
            raise InputError(f"missing {' and '.join(missing)}", source=body.source, key=body.label)


def _refuse_other_canvases(bodies: Sequence[Candidate], roles: Sequence[str]) -> None:
    first, *others = bodies
    for body in others:
        for role in roles:
            one, other = first.design.roles[role].shape, body.design.roles[role].shape
            if one != other:
                raise InputError(
                    f"shape is {list(other)}, but {list(one)} in {first.source}; only bodies on the same "
                    "canvas can be compared",
                    source=body.source,
                    key=role,
                )
