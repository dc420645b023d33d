"""Which bodies are measured together, and how: what a person names, read and found to fit together."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import attrs

from evoframe.config import Layer, load_config
from evoframe.contract import RunConfig, SupportsPublished, SupportsRandomControllers, blaming
from evoframe.designs import DEFAULT_PRESET, Job, read_job
from evoframe.documents import differences
from evoframe.errors import ConfigurationError, InputError
from evoframe.files import is_file, shown_name
from evoframe.registry import Plugins
from evoframe.robustness.measurement import Candidate
from evoframe.study import STUDY_FILE, Planned, name_of, read_study, shown, survey

__all__ = ["Candidates", "Part", "champions", "read_candidates"]


@attrs.frozen(eq=False)
class Candidates:
    """Bodies that can be measured together.

    Attributes:
        config: What simulates, scores and spreads over workers.
        bodies: At least one; all of one canvas, and no two of one name.
    """

    config: RunConfig
    bodies: tuple[Candidate, ...]


@attrs.frozen(eq=False)
class Part:
    """The bodies of one file or run.

    Attributes:
        named: What a person named to get them.
        config: How they are simulated.
        bodies: At least one.
    """

    named: str
    config: RunConfig
    bodies: tuple[Candidate, ...]


def read_candidates(
    sources: Sequence[Path],
    preset: str | None,
    overrides: Sequence[str | Layer],
    plugins: Plugins,
    *,
    published: bool = False,
) -> Candidates:
    """Read the bodies that a person names.

    A study stands for the champions of its finished runs, a group for each configuration; a run and a file
    are read as :func:`~evoframe.designs.sources.read_job` does, and each of their bodies is a group
    of its own.

    Args:
        sources: Directories of studies and runs, and files with designs.
        preset: Name of a preset, or path of a TOML file, with which all are simulated.
        overrides: ``key=value``, or layers, for all.
        plugins: The plugins to choose from.
        published: Whether the bodies that the simulator brings join; they are simulated as the first source
            is, or with the preset (``paper`` if none is named) if there is no other.

    Raises:
        InputError: Something cannot be read, or what was read does not fit together; says what and why.
        ConfigurationError: It cannot be simulated like this.
    """
    studies = [path for path in sources if _is_study(path)]
    alike = len({shown_name(path) for path in studies}) < len(studies)
    names = {path: _text(path) if alike else shown_name(path) for path in studies} if len(studies) > 1 else {}
    reader = _Reader(preset, overrides, plugins, names)
    parts = [part for path in sources for part in _some(reader, path)]
    if published:
        config = parts[0].config if parts else _config(preset, overrides, plugins)
        parts.append(_published(config))
    bodies = tuple(body for part in parts for body in part.bodies)
    if not bodies:
        raise InputError("there is no body to measure; name runs, studies or files, or use --published")
    _refuse_other_simulations(parts)
    _refuse_same_names(parts)
    config = parts[0].config
    if not isinstance(config.simulator.component, SupportsRandomControllers):
        raise ConfigurationError(
            f"the simulator '{config.simulator.name}' draws no random controllers, so there is nothing that "
            "bodies could be measured with"
        )
    _refuse_other_canvases(bodies, config.simulator.component.requires)
    return Candidates(config, bodies)


def champions(directory: Path, plugins: Plugins) -> Iterator[Part]:
    """Return the champion of a run, or those of the finished runs of a study that are there.

    Args:
        directory: Of the run or study.
        plugins: The plugins to choose from.

    Raises:
        InputError: One of them is damaged.
        ConfigurationError: One of them cannot be simulated with these plugins.
    """
    return _Reader(None, (), plugins, {}).parts(directory)


@attrs.frozen
class _Reader:
    """Reads what a person names, one after the other; *studies* are the names of several studies."""

    preset: str | None
    overrides: Sequence[str | Layer]
    plugins: Plugins
    studies: Mapping[Path, str]

    def parts(self, path: Path) -> Iterator[Part]:
        if _is_study(path):
            yield from self._of_study(path)
        else:
            yield _of_job(self._job(path))

    def _job(self, path: Path, own: Sequence[Layer] = ()) -> Job:
        return read_job(path, self.preset, [*own, *self.overrides], self.plugins, runs=True)

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
    """Return the parts of a source, which has one at least."""
    found = list(reader.parts(path))
    if not found:
        raise InputError(f"{path}: no run of this study is finished here, so it has no champions")
    return found


def _is_study(path: Path) -> bool:
    return is_file(path / STUDY_FILE)


def _executor(planned: Planned) -> Layer:
    """Return what gives bodies all workers of their study: its runs have one each."""
    return Layer("the study", {"executor": planned.cell.config.tables()["executor"]})


def _of_job(job: Job) -> Part:
    """Return the bodies of a run or file, each on its own; one that is alone in a file has its path."""
    named = _text(job.path)
    labels = [named if label in (job.path.name, str(job.path)) else label for label in job.labels]
    bodies = [
        Candidate(label, label, design, named) for label, design in zip(labels, job.designs, strict=True)
    ]
    return Part(named, job.config, tuple(bodies))


def _text(path: Path) -> str:
    """Return a path as it stands in files: text, whatever its bytes are."""
    return str(path).encode("utf-8", "replace").decode()


def _config(preset: str | None, overrides: Sequence[str | Layer], plugins: Plugins) -> RunConfig:
    return load_config(preset or DEFAULT_PRESET, overrides=overrides, plugins=plugins)


def _published(config: RunConfig) -> Part:
    simulator = config.simulator.component
    if not isinstance(simulator, SupportsPublished):
        raise ConfigurationError(f"the simulator '{config.simulator.name}' brings no published bodies")
    named = f"published with {config.simulator.name}"
    with blaming("simulator"):
        bodies = [Candidate(label, label, design, named) for label, design in simulator.published()]
    return Part(named, config, tuple(bodies))


def _refuse_other_simulations(parts: Sequence[Part]) -> None:
    first, *others = parts
    for part in others:
        lines = differences(first.config.simulation(), part.config.simulation(), ("there", "here"))
        if lines:
            one, other = first.bodies[0].source, part.bodies[0].source
            listed = "\n  ".join(lines)
            raise InputError(
                f"{other}: is simulated otherwise than {one}; name a preset for all (--preset), or set what "
                f"differs (--set):\n  {listed}"
            )


def _refuse_same_names(parts: Sequence[Part]) -> None:
    owners: dict[str, str] = {}
    labels: set[str] = set()
    for part in parts:
        for body in part.bodies:
            owner = owners.setdefault(body.group, part.named)
            if owner != part.named or body.label in labels:
                raise InputError(
                    f"{part.named}: '{body.group}' is the name of a body or group of {owner} already; name "
                    "each once, and what only looks alike by another path"
                )
            labels.add(body.label)


def _refuse_other_canvases(bodies: Sequence[Candidate], roles: Sequence[str]) -> None:
    first, *others = bodies
    for body in others:
        for role in roles:
            one, other = first.design.roles[role].shape, body.design.roles[role].shape
            if one != other:
                raise InputError(
                    f"{body.source}: {role} has the shape {list(other)}, but in {first.source} it has "
                    f"{list(one)}; bodies have controllers in common only on one canvas"
                )
