"""Measure the speed of evoframe and the time of its parts; compared actions are interleaved in one run."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import click
from rich.console import Console
from rich.markup import escape

from benchmarks.machine import BUSY, load, machine
from benchmarks.report import Section, SectionError, show
from benchmarks.sections.evaluations import evaluations
from benchmarks.sections.evolution import evolution
from benchmarks.sections.kernels import kernels
from benchmarks.sections.networks import networks
from benchmarks.sections.roofline import roofline
from benchmarks.sections.runs import runs
from benchmarks.sections.startup import startup
from benchmarks.sections.threads import threads
from benchmarks.timing import FULL, QUICK, Effort

SECTIONS: dict[str, Callable[[Effort], Section]] = {
    "kernels": kernels,
    "evaluations": evaluations,
    "threads": threads,
    "networks": networks,
    "evolution": evolution,
    "runs": runs,
    "startup": startup,
    "roofline": roofline,
}
_WIDTH = 132  # of output that is not a terminal


@click.command(help=__doc__)
@click.option("--quick", is_flag=True, help="Only check that everything works; the figures are not reliable.")
@click.option(
    "--only", multiple=True, type=click.Choice(list(SECTIONS)), help="Measure only this section. Repeatable."
)
@click.option(
    "--json", "file", type=click.Path(path_type=Path, dir_okay=False), help="Also write the figures as JSON."
)
def main(*, quick: bool, only: tuple[str, ...], file: Path | None) -> None:
    """Measure and print all sections; exit with 1 if one failed."""
    console = Console(width=None if sys.stdout.isatty() else _WIDTH)
    about = machine()
    _introduce(console, about)
    measured: dict[str, Any] = {}
    failed: dict[str, str] = {}
    for name in only or SECTIONS:
        try:
            section = SECTIONS[name](QUICK if quick else FULL)
        except SectionError as error:
            failed[name] = str(error)
            console.print(f"\n[bold]{name}[/] failed: {escape(str(error))}", highlight=False)
        else:
            measured[name] = section.to_json()
            show(console, name, section)
    if file is not None:
        document = {"machine": about, "quick": quick, "sections": measured, "failed": failed}
        file.write_text(json.dumps(document, indent=2, allow_nan=False) + "\n", encoding="utf-8")
    if failed:
        sys.exit(1)


def _introduce(console: Console, about: dict[str, str]) -> None:
    for name, value in about.items():
        console.print(f"{name + ':':<20}{value}", highlight=False, markup=False, soft_wrap=True)
    if load() > BUSY:
        console.print("The machine is busy: other processes may disturb the figures.", style="bold yellow")


if __name__ == "__main__":
    main(prog_name="python -m benchmarks")
