"""What several commands share."""

from __future__ import annotations

import logging
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, TypeVar

import attrs
import click
from click.shell_completion import CompletionItem
from rich.console import Console

from evoframe.errors import InputError

if TYPE_CHECKING:
    from evoframe.config import Layer
    from evoframe.registry import Plugins

__all__ = [
    "common_options",
    "configuration_argument",
    "correction_option",
    "is_quiet",
    "messages",
    "modules_of",
    "needing_extra",
    "output",
    "plugins_of",
    "preset_option",
    "scored",
    "set_option",
    "workers_option",
]

F = TypeVar("F", bound=Callable[..., Any])


@attrs.define
class _Common:
    """What the common options say, wherever on the command line they stand.

    Attributes:
        modules: Local plugins.
        verbosity: How much is told; below 0: only what was asked for, and errors.
        plugins: What was discovered, once somebody asked for it.
    """

    modules: list[str] = attrs.field(factory=list)
    verbosity: int = 0
    plugins: Plugins | None = None


class _Handler(logging.Handler):
    """Writes to whatever standard error is at the time, which a progress bar takes over while it is shown."""

    def emit(self, record: logging.LogRecord) -> None:
        sys.stderr.write(f"{self.format(record)}\n")


def _common(ctx: click.Context) -> _Common:
    return ctx.find_root().ensure_object(_Common)


def _add_modules(ctx: click.Context, _: click.Parameter, modules: tuple[str, ...]) -> None:
    _common(ctx).modules += modules


def _speak(ctx: click.Context, parameter: click.Parameter, value: int) -> None:
    if value:
        common = _common(ctx)
        common.verbosity = -1 if parameter.name == "quiet" else common.verbosity + value
    level = logging.WARNING - 10 * min(_common(ctx).verbosity, 2)
    logging.basicConfig(level=level, handlers=[_Handler()], format="%(name)s: %(message)s", force=True)


def common_options(function: F) -> F:
    """Add ``-v``, ``-q`` and ``-p``, which may stand before or after the name of a command."""
    for option in (
        click.option(
            "-p",
            "--plugin",
            multiple=True,
            is_eager=True,  # before --help, which lists the commands of plugins too
            expose_value=False,
            callback=_add_modules,
            metavar="MODULE",
            help="Use a plugin that is one local module: an importable name or a .py file. Repeatable.",
        ),
        click.option(
            "-q",
            "--quiet",
            is_flag=True,
            expose_value=False,
            callback=_speak,
            help="Say only what was asked for.",
        ),
        click.option(
            "-v",
            "--verbose",
            count=True,
            expose_value=False,
            callback=_speak,
            help="Say more; twice: everything.",
        ),
    ):
        function = option(function)
    return function


def output() -> Console:
    """Return where tables go: what a user wrote is no markup, and nothing is cut but by a terminal."""
    console = Console(markup=False, emoji=False, highlight=False)
    return console if console.is_terminal else Console(markup=False, emoji=False, highlight=False, width=4096)


def messages() -> Console:
    """Return where progress goes: the terminal, if the standard error is one."""
    return Console(
        stderr=True, markup=False, emoji=False, highlight=False, force_terminal=sys.stderr.isatty()
    )


def scored(score: float | None, unit: str) -> str:
    """Return a score with all its digits and its *unit*."""
    return "diverged" if score is None else f"{score!r} {unit}".rstrip()


def is_quiet(ctx: click.Context) -> bool:
    """Return whether only what was asked for shall be said."""
    return _common(ctx).verbosity < 0


def modules_of(ctx: click.Context) -> tuple[str, ...]:
    """Return the local plugins that were named, for other processes to discover."""
    return tuple(_common(ctx).modules)


def plugins_of(ctx: click.Context) -> Plugins:
    """Return the plugins of this invocation, discovered once."""
    from evoframe.registry import discover

    common = _common(ctx)
    if common.plugins is None:
        common.plugins = discover(common.modules)
    return common.plugins


def _complete_preset(_: click.Context, __: click.Parameter, incomplete: str) -> list[CompletionItem]:
    from evoframe.config import preset_names

    presets = [CompletionItem(name) for name in preset_names() if name.startswith(incomplete)]
    return [*presets, CompletionItem(incomplete, type="file")]


def configuration_argument(function: F) -> F:
    """Add the argument that names a preset or a file."""
    return click.argument(
        "source", metavar="[CONFIG|PRESET]", default="paper", shell_complete=_complete_preset
    )(function)


def preset_option(function: F) -> F:
    """Add ``--preset P`` to a command that takes files."""
    return click.option(
        "--preset",
        metavar="P",
        shell_complete=_complete_preset,
        help="What the file does not say is as in this preset; a champion is simulated as in its run, "
        "unless a preset is named.  [default: paper]",
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


def correction_option(function: F) -> F:
    """Add ``--correction C`` to a command that compares pairs of groups."""
    from evoframe.analysis.statistics.corrections import CORRECTIONS

    return click.option(
        "--correction",
        type=click.Choice(CORRECTIONS),
        default="holm",
        show_default=True,
        help="Of the p-values for the number of pairs; the paper uses none.",
    )(function)


@contextmanager
def needing_extra(extra: str, what: str) -> Iterator[None]:
    """Say what to install where an import fails, for it is of an extra.

    Args:
        extra: The extra.
        what: What it is for, in words.

    Raises:
        InputError: A module is not installed.
    """
    try:
        yield
    except ModuleNotFoundError as error:
        name = str(error.name).partition(".")[0]
        raise InputError(f"{name} is not installed; for {what}: pip install 'evoframe[{extra}]'") from error


def _workers_layer(_: click.Context, __: click.Parameter, workers: int | None) -> list[Layer]:
    from evoframe.config import layer_of

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
