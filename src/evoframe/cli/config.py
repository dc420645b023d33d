"""``evoframe config``."""

from __future__ import annotations

import os
from pathlib import Path

import click

from evoframe.cli.context import (
    command,
    common_options,
    configuration_argument,
    plugins_of,
    read_preset,
    set_option,
)
from evoframe.cli.streams import echo
from evoframe.cli.writing import STDOUT, files_of_settings, force_option, write_file
from evoframe.config import Layers, commented, complete_config, load_config, preset_names, starter
from evoframe.errors import InputError
from evoframe.files import is_file

__all__ = ["config"]


@click.group()
@common_options
def config() -> None:
    """Print configurations, or write a new one."""


@config.command(
    epilog="""\b
Examples:
  evoframe config show
  evoframe config show --comments | less
  evoframe config show my.toml --set aggregator=gm > resolved.toml
"""
)
@configuration_argument
@set_option
@click.option("--comments", is_flag=True, help="Add the meaning, type and range of every option.")
@common_options
@click.pass_context
def show(ctx: click.Context, source: str, overrides: tuple[str, ...], comments: bool) -> None:
    """Check a configuration and print it with every default."""
    resolved = load_config(source, overrides=overrides, plugins=plugins_of(ctx))
    echo(commented(resolved) if comments else resolved.to_toml(), nl=False)


@config.command(
    epilog="""\b
Examples:
  evoframe config new my.toml
  evoframe config new my.toml --preset bending
"""
)
@click.argument("path", metavar="FILE", type=click.Path(path_type=Path, allow_dash=True))
@click.option(
    "--preset",
    default="paper",
    show_default=True,
    callback=read_preset,
    metavar="P",
    help="Preset to start from.",
)
@force_option
@common_options
@click.pass_context
def new(ctx: click.Context, path: Path, preset: Layers, force: bool) -> None:
    """Write a configuration to start from, with a comment on every option.

    FILE is the file to write, such as my.toml; - is standard output. Every option is commented out and has
    its value in the preset. If the preset is a pipe, which no file can extend, all options are set.
    """
    resolved = complete_config(preset, (), plugins_of(ctx))
    text = starter(resolved, _base(preset, path)) if _can_be_extended(preset) else commented(resolved)
    try:
        data = text.encode()
    except UnicodeEncodeError as error:
        raise InputError(
            "its name is not UTF-8 text, as TOML requires; rename it", source=preset.source
        ) from error
    write_file(path, data, force=force, inputs=files_of_settings(ctx, preset))
    if path != STDOUT:
        click.echo(f"To run it: {command(ctx, 'run', path)}", err=True)


def _can_be_extended(preset: Layers) -> bool:
    return preset.source in preset_names() or is_file(Path(preset.source))


def _base(preset: Layers, path: Path) -> str:
    """Return how a file with this *path* names the preset."""
    base = Path(preset.source)
    if preset.source in preset_names() or path == STDOUT or base.is_absolute():
        return preset.source
    return os.path.relpath(base.parent.resolve() / base.name, path.parent.resolve())
