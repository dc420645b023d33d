"""What several commands share."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import click
from click.shell_completion import CompletionItem

from evoframe.discovery import discover
from evoframe.layers import Layer, layer_of, preset_names
from evoframe.plugins import Plugins

__all__ = ["configuration_argument", "plugins_of", "set_option", "workers_option"]

F = TypeVar("F", bound=Callable[..., Any])


def plugins_of(ctx: click.Context) -> Plugins:
    """Return the plugins of this invocation, discovered once."""
    root = ctx.find_root()
    if root.obj is None:
        root.obj = discover(root.params.get("plugin") or ())
    found: Plugins = root.obj
    return found


def _complete_preset(_: click.Context, __: click.Parameter, incomplete: str) -> list[CompletionItem]:
    presets = [CompletionItem(name) for name in preset_names() if name.startswith(incomplete)]
    return [*presets, CompletionItem(incomplete, type="file")]


def configuration_argument(function: F) -> F:
    """Add the argument that names a preset or a file."""
    return click.argument(
        "source", metavar="[CONFIG|PRESET]", default="paper", shell_complete=_complete_preset
    )(function)


def set_option(function: F) -> F:
    """Add ``--set key=value``."""
    return click.option(
        "--set",
        "overrides",
        multiple=True,
        metavar="KEY=VALUE",
        help="Override a setting; the value is TOML, a bare word is a string. Repeatable.",
    )(function)


def _workers_layer(_: click.Context, __: click.Parameter, workers: int | None) -> list[Layer]:
    return [] if workers is None else [layer_of(f"--workers {workers}", "executor.workers", workers)]


def workers_option(function: F) -> F:
    """Add ``--workers N``, which comes as the layers that it sets."""
    return click.option(
        "--workers",
        type=click.IntRange(min=0),
        callback=_workers_layer,
        metavar="N",
        help="Simulate on N cores at once; 0: all. The results are the same.",
    )(function)
