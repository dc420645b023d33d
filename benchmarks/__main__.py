"""Measure the speed of evoframe and the time of its parts; compared actions are interleaved in one run."""

from __future__ import annotations

import contextlib
import functools
import json
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any, TypeAlias

import attrs
import click
from rich.console import Console
from rich.markup import escape

from benchmarks.against.cases import CASES
from benchmarks.against.comparison import comparing
from benchmarks.machine import BUSY, load, machine
from benchmarks.report import Section, SectionError, show
from benchmarks.sections.evaluations import evaluations
from benchmarks.sections.evolution import evolution
from benchmarks.sections.kernels import kernels
from benchmarks.sections.networks import networks
from benchmarks.sections.peers import peers
from benchmarks.sections.roofline import roofline
from benchmarks.sections.runs import runs
from benchmarks.sections.startup import startup
from benchmarks.sections.threads import threads
from benchmarks.timing import FULL, QUICK, Effort

_Measurement: TypeAlias = Callable[[Effort], Section]

SECTIONS: dict[str, _Measurement] = {
    "kernels": kernels,
    "evaluations": evaluations,
    "threads": threads,
    "networks": networks,
    "evolution": evolution,
    "runs": runs,
    "startup": startup,
    "roofline": roofline,
    "peers": peers,
}
_WIDTH = 132  # of output that is not a terminal


@click.command(help=__doc__)
@click.option("--quick", is_flag=True, help="Only check that everything works; the figures are not reliable.")
@click.option(
    "--against", "revision", metavar="REV", help="Build this git revision, and compare this version with it."
)
@click.option(
    "--only",
    multiple=True,
    metavar="NAME",
    help="Measure only this section or, with --against, this case. Repeatable.",
)
@click.option(
    "--rounds", type=click.IntRange(min=1), metavar="N", help="Number of rounds of each measurement."
)
@click.option(
    "--json", "file", type=click.Path(path_type=Path, dir_okay=False), help="Also write the figures as JSON."
)
def main(
    *, quick: bool, revision: str | None, only: tuple[str, ...], rounds: int | None, file: Path | None
) -> None:
    """Measure and print all sections; exit with 1 if one failed."""
    names = _selected(only, SECTIONS if revision is None else CASES)
    console = Console(width=None if sys.stdout.isatty() else _WIDTH)
    about = machine()
    _print_lines(console, about)
    if load() > BUSY:
        console.print("The machine is busy: other processes may disturb the figures.", style="bold yellow")
    measured: dict[str, Any] = {}
    failed: dict[str, str] = {}
    with _reporting(console, "--against", failed), _sections(console, about, revision) as sections:
        for name in names:
            with _reporting(console, name, failed):
                section = sections[name](_effort(quick=quick, rounds=rounds))
                measured[name] = section.to_json()
                show(console, name, section)
    if file is not None:
        document = {"machine": about, "quick": quick, "sections": measured, "failed": failed}
        file.write_text(json.dumps(document, indent=2, allow_nan=False) + "\n", encoding="utf-8")
    if failed:
        sys.exit(1)


def _selected(only: tuple[str, ...], available: Iterable[str]) -> list[str]:
    names = list(available)
    if unknown := [name for name in only if name not in names]:
        raise click.BadParameter(f"'{unknown[0]}' is not one of {', '.join(names)}.", param_hint="'--only'")
    return list(only) or names


def _effort(*, quick: bool, rounds: int | None) -> Effort:
    effort = QUICK if quick else FULL
    if rounds is None:
        return effort
    return attrs.evolve(effort, rounds=rounds, run_rounds=rounds, command_rounds=rounds)


@contextlib.contextmanager
def _sections(
    console: Console, about: dict[str, str], revision: str | None
) -> Iterator[Mapping[str, _Measurement]]:
    """Provide the sections, or the cases of a comparison with another commit."""
    if revision is None:
        yield SECTIONS
        return
    with comparing(revision) as comparison:
        _print_lines(console, comparison.about)
        about.update(comparison.about)
        yield {name: functools.partial(case, comparison) for name, case in CASES.items()}


@contextlib.contextmanager
def _reporting(console: Console, name: str, failed: dict[str, str]) -> Iterator[None]:
    """Print and keep the failure of a measurement."""
    try:
        yield
    except SectionError as error:
        failed[name] = str(error)
        console.print(f"\n[bold]{name}[/] failed: {escape(str(error))}", highlight=False)


def _print_lines(console: Console, about: Mapping[str, str]) -> None:
    for name, value in about.items():
        console.print(f"{name + ':':<20}{value}", highlight=False, markup=False, soft_wrap=True)


if __name__ == "__main__":
    main(prog_name="python -m benchmarks")
