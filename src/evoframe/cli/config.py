"""``evoframe config``."""

from __future__ import annotations

import click

from evoframe.cli.context import common_options, configuration_argument, plugins_of, set_option
from evoframe.config import load_config

__all__ = ["config"]


@click.group()
@common_options
def config() -> None:
    """Print configurations, or write a new one."""


_EPILOG = """\b
Examples:
  evoframe config show
  evoframe config show my.toml --set aggregator=gm > resolved.toml
"""


@config.command(epilog=_EPILOG)
@configuration_argument
@set_option
@common_options
@click.pass_context
def show(ctx: click.Context, source: str, overrides: tuple[str, ...]) -> None:
    """Check a configuration and print it with every default."""
    resolved = load_config(source, overrides=overrides, plugins=plugins_of(ctx))
    click.echo(resolved.to_toml(), nl=False)
