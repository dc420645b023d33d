"""``evoframe simulate``."""

from __future__ import annotations

import csv
import json
from collections.abc import Iterator
from pathlib import Path

import attrs
import click
from rich.table import Table

from evoframe.champion import read_champion
from evoframe.cli.context import (
    common_options,
    output,
    plugins_of,
    scored,
    set_option,
    unit_of,
    workers_option,
)
from evoframe.config import RunConfig
from evoframe.errors import ConfigurationError, InputError
from evoframe.evaluation import Score
from evoframe.layers import Layer
from evoframe.plugins import Plugins
from evoframe.resolve import load_config
from evoframe.run import evaluator_of
from evoframe.values import Design, Record

__all__ = ["simulate"]

_EPILOG = """\b
Examples:
  evoframe simulate runs/paper-1/champion.json
  evoframe simulate bodies.npz --json
  evoframe simulate body.npz --set simulator.expansion_coefficient=0 --trace trace.csv
"""


@attrs.frozen
class _Job:
    """The designs of one file, and the configuration that they are simulated with."""

    path: Path
    config: RunConfig
    labels: tuple[str, ...]
    designs: tuple[Design, ...]


@click.command(epilog=_EPILOG)
@click.argument("files", metavar="FILE...", nargs=-1, required=True, type=click.Path(path_type=Path))
@click.option("--preset", metavar="P", help="Simulate as this preset does (a champion: as its run did).")
@set_option
@click.option("--json", "as_json", is_flag=True, help="Print JSON, with full precision.")
@click.option(
    "--trace",
    type=click.Path(path_type=Path, dir_okay=False),
    metavar="OUT.csv",
    help="Write where the points of one body are after every step.",
)
@workers_option
@common_options
@click.pass_context
def simulate(
    ctx: click.Context,
    files: tuple[Path, ...],
    preset: str | None,
    overrides: tuple[str, ...],
    as_json: bool,
    trace: Path | None,
    workers: list[Layer],
) -> None:
    """Simulate given bodies and print the displacement of each.

    A FILE is a run's champion.json, or an .npz with material ([X,Y,Z] or [N,X,Y,Z]; codes 0 empty, 1 passive,
    3 contractile) and phase_cycles of the same shape.
    """
    jobs = [_read(path, preset, [*overrides, *workers], plugins_of(ctx)) for path in files]
    if trace is not None:
        _write_trace(trace, jobs)
    scores = [_evaluate(job) for job in jobs]
    if as_json:
        click.echo(_json([score for some in scores for score in some]))
    else:
        output().print(_table(jobs, scores))


def _read(path: Path, preset: str | None, overrides: list[str | Layer], plugins: Plugins) -> _Job:
    if path.suffix == ".json":
        design, simulation, _ = read_champion(path)
        own = [] if preset else [Layer(str(path), simulation)]
        config = load_config(preset or "paper", overrides=[*own, *overrides], plugins=plugins)
        _check_roles(path, design, config)
        return _Job(path, config, (path.name,), (design,))
    config = load_config(preset or "paper", overrides=overrides, plugins=plugins)
    read = getattr(config.simulator.component, "read", None)
    if read is None:
        raise ConfigurationError(f"the simulator '{config.simulator.name}' reads no files")
    labels, designs = zip(*read(path), strict=True)
    return _Job(path, config, labels, designs)


def _check_roles(path: Path, design: Design, config: RunConfig) -> None:
    missing = [role for role in config.simulator.component.requires if role not in design.roles]
    if missing:
        raise InputError(f"{path}: design: has no {' and no '.join(missing)}")


def _evaluate(job: _Job) -> list[Score]:
    evaluator = evaluator_of(job.config)
    try:
        return evaluator.evaluate(job.designs)
    except InputError as error:
        raise InputError(f"{job.path}: {error}") from error
    finally:
        evaluator.close()


def _json(scores: list[Score]) -> str:
    return json.dumps(
        {
            "displacement": [score.value for score in scores],
            "diverged": [score.value is None for score in scores],
        }
    )


def _table(jobs: list[_Job], scores: list[list[Score]]) -> Table:
    table = Table(box=None, header_style="bold")
    table.add_column("body", overflow="fold")
    table.add_column("displacement", overflow="fold")
    for job, some in zip(jobs, scores, strict=True):
        unit = unit_of(job.config)
        for label, score in zip(job.labels, some, strict=True):
            step = f" at step {score.diverged_at}" if score.value is None else ""
            table.add_row(label, scored(score.value, unit) + step)
    return table


def _write_trace(path: Path, jobs: list[_Job]) -> None:
    bodies = [(job, design) for job in jobs for design in job.designs]
    if len(bodies) != 1:
        raise InputError(f"--trace writes the trace of one body, but {len(bodies)} were given")
    [(job, design)] = bodies
    try:
        rows = list(_trace(job.config, design))
        with path.open("w", newline="", encoding="utf-8") as file:
            csv.writer(file, lineterminator="\n").writerows(rows)
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror}") from error
    except InputError as error:
        raise InputError(f"{job.path}: {error}") from error


def _trace(config: RunConfig, design: Design) -> Iterator[list[str]]:
    """Yield a header and one row a step, the state before the first step in front."""
    simulator = config.simulator.component
    record = Record(tracks=simulator.tracks, initial=True)
    [outcome] = simulator.simulate([design], record)
    yield ["step", "time", *(f"{track}_{axis}" for track in record.tracks for axis in "xyz")]
    for row, (step, time) in enumerate(zip(outcome.steps.tolist(), outcome.times.tolist(), strict=True)):
        points = [value for track in record.tracks for value in outcome.tracks[track][row].tolist()]
        yield [str(step), repr(time), *map(repr, points)]
