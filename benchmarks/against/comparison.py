"""The processes of a comparison of two commits, and the measurements that they make in turns."""

from __future__ import annotations

import contextlib
import functools
import math
import sys
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import attrs
import numpy as np

from benchmarks.against.builds import build, describe
from benchmarks.against.results import Result
from benchmarks.child import CHILDREN, Child, started
from benchmarks.pairs import alternated
from benchmarks.recording import Batch
from benchmarks.report import SectionError
from benchmarks.timing import Effort
from evoframe import CONTROLLER, MORPHOLOGY

__all__ = ["ROOT", "SIDES", "Command", "Comparison", "Measured", "comparing"]

ROOT = Path(__file__).parents[2]
"""The checkout of this version of evoframe."""

SIDES = ("this", "other")
"""This version of evoframe, and the other commit."""


@attrs.frozen
class Command:
    """The command ``evoframe run``.

    Attributes:
        preset: The preset to run.
        settings: Overrides as ``key=value``.
        seeds: One for each run.
    """

    preset: str
    settings: Sequence[str]
    seeds: Sequence[int] = (1,)


@attrs.frozen
class Measured:
    """Measurements of both commits, in turns, and their results.

    Attributes:
        times: Side -> clock -> times, s; the clocks are ``cpu``, and ``wall`` for commands.
        results: Side -> results.
        simulations: Side -> number of simulations, for commands.
    """

    times: Mapping[str, Mapping[str, Sequence[float]]]
    results: Mapping[str, Sequence[Result]]
    simulations: Mapping[str, int] = {}


@attrs.frozen
class Comparison:
    """Two commits that are compared.

    Attributes:
        about: Side -> its commit.
        children: Side -> the process that measures with it.
        directory: Folder for files that both read.
    """

    about: Mapping[str, str]
    children: Mapping[str, Child]
    directory: Path

    def simulate(self, name: str, preset: str, batches: Sequence[Batch], effort: Effort) -> Measured:
        """Simulate and score batches of designs with the settings of a preset."""
        file = self.directory / f"{name}.npz"
        _save(file, batches)
        self._ask("load", name=name, preset=preset, file=str(file))
        results = self._ask("results", name=name)
        once = min(self._ask("measure", name=name, times=1).values())
        times = max(1, math.ceil(effort.shortest / once)) if once > 0.0 else 1
        taken = self._alternated("measure", effort.rounds, name=name, times=times)
        return Measured(
            {side: {"cpu": taken[side]} for side in SIDES},
            {side: [Result(*result) for result in results[side]] for side in SIDES},
        )

    def run(self, command: Command, effort: Effort) -> Measured:
        """Execute a command with each of its seeds; the times are sums."""
        taken = self._alternated("run", effort.command_rounds, **attrs.asdict(command))
        return Measured(
            {
                side: {clock: [run[clock] for run in taken[side]] for clock in ("wall", "cpu")}
                for side in SIDES
            },
            {side: [Result(*result) for result in taken[side][-1]["results"]] for side in SIDES},
            {side: taken[side][-1]["simulations"] for side in SIDES},
        )

    def _ask(self, do: str, **arguments: Any) -> dict[str, Any]:
        return {side: self.children[side].ask(do, **arguments) for side in SIDES}

    def _alternated(self, do: str, rounds: int, **arguments: Any) -> dict[str, list[Any]]:
        measures = {side: functools.partial(self.children[side].ask, do, **arguments) for side in SIDES}
        return alternated(measures, rounds)


@contextlib.contextmanager
def comparing(revision: str, root: Path = ROOT) -> Iterator[Comparison]:
    """Build another commit, and start a process with it and one with this version of evoframe.

    Raises:
        SectionError: The commit is unknown, or it cannot be built or started.
    """
    with tempfile.TemporaryDirectory(prefix="evoframe-") as name, contextlib.ExitStack() as stack:
        directory = Path(name)
        other = build(root, revision, directory)
        command = [sys.executable, str(CHILDREN / "evoframe_child.py")]
        children = {
            "this": stack.enter_context(started("this version", command, {})),
            "other": stack.enter_context(started(other.about, command, {"PYTHONPATH": str(other.site)})),
        }
        _check_origins(children["other"], other.site)
        yield Comparison({"this": describe(root), "other": other.about}, children, directory)


def _check_origins(child: Child, site: Path) -> None:
    """Check that a process does not load the packages of this version."""
    for package, file in child.ask("origins").items():
        if file is None or not Path(file).resolve().is_relative_to(site.resolve()):
            raise SectionError(f"{child.name} loads {package} from {file}, expected a file in {site}")


def _save(file: Path, batches: Sequence[Batch]) -> None:
    """Save batches of designs for processes that may have another class for designs."""
    designs = [design for batch in batches for design in batch]
    np.savez(
        file,
        batch=np.repeat(np.arange(len(batches)), [len(batch) for batch in batches]),
        body=np.stack([design.roles[MORPHOLOGY] for design in designs]),
        phases=np.stack([design.roles[CONTROLLER] for design in designs]),
    )
