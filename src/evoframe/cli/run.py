"""``evoframe run``."""

from __future__ import annotations

from pathlib import Path

import click

from evoframe.cli.context import (
    common_options,
    configuration_argument,
    plugins_of,
    set_option,
    workers_option,
)
from evoframe.cli.playing import play
from evoframe.cli.sources import read_configuration
from evoframe.config import Layer, complete_config, layer_of
from evoframe.runs import prepare

__all__ = ["run"]

_EPILOG = """\b
Examples:
  evoframe run                                    the published experiment (preset paper)
  evoframe run quick --seed 3 --out runs/try
  evoframe run --set aggregator=hm --set collaboration.n=5
  evoframe run my.toml --set 'aggregator={name="wm", weights=[0.7, 0.3]}'
"""


@click.command(epilog=_EPILOG)
@configuration_argument
@set_option
@click.option(
    "--seed", type=click.IntRange(min=0), metavar="N", help="Seed of the run; same as --set run.seed=N."
)
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar="DIR",
    help="Directory to write the run to.  [default: runs/NAME-SEED, with the settings that were changed]",
)
@workers_option
@common_options
@click.pass_context
def run(
    ctx: click.Context,
    source: str,
    overrides: tuple[str, ...],
    seed: int | None,
    out: Path | None,
    workers: list[Layer],
) -> None:
    """Run one coevolution.

    The argument is a configuration file (TOML) or a preset; the default is the preset paper. Every turn is
    saved: Ctrl-C stops after the turn in progress, a second Ctrl-C at once, and evoframe resume continues.
    At the end, the champion is verified as by evoframe verify.
    """
    base = read_configuration(ctx, source)
    extra = [] if seed is None else [layer_of(f"--seed {seed}", "run.seed", seed)]
    plugins = plugins_of(ctx)
    config = complete_config(base, [*overrides, *extra, *workers], plugins)
    play(ctx, prepare(config, plugins, out))
