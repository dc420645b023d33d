"""Options and output shared by several commands."""

from __future__ import annotations

import functools
import logging
import shlex
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, TypeVar, cast

import attrs
import click
from click.shell_completion import CompletionItem
from rich.console import Console

from evoframe.cli.streams import divert_plugin_text, requested_output
from evoframe.errors import InputError
from evoframe.messages import quantity

if TYPE_CHECKING:
    from evoframe.config import Layer, Layers
    from evoframe.contract import Design, RunConfig, Score
    from evoframe.record import Run
    from evoframe.registry import Plugins

__all__ = [
    "command",
    "common_options",
    "configuration_argument",
    "correction_option",
    "is_quiet",
    "messages",
    "modules_of",
    "needing_extra",
    "output",
    "plugin_options",
    "plugins_of",
    "preset_option",
    "read_preset",
    "scored",
    "set_option",
    "span",
    "warn_overlooked",
    "warn_unreproduced",
    "workers_option",
]

F = TypeVar("F", bound=Callable[..., Any])


@attrs.define
class _Common:
    """Values of the common options, collected from before and after the name of the command.

    Attributes:
        modules: Local plugins.
        verbosity: Number of ``-v``; below 0: only the requested output and errors.
        plugins: The plugins, discovered on first use.
    """

    modules: list[str] = attrs.field(factory=list)
    verbosity: int = 0
    plugins: Plugins | None = None


class _Handler(logging.Handler):
    """A handler that writes to the current ``sys.stderr``, which a progress bar replaces while it runs."""

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
    """Add ``-v``, ``-q`` and ``-p``, which are accepted before or after the name of a command.

    What plugins print while the command works goes to standard error.
    """
    function = _diverting(function)
    for option in (
        click.option(
            "-p",
            "--plugin",
            multiple=True,
            is_eager=True,  # before --help, which also lists the commands of plugins
            expose_value=False,
            callback=_add_modules,
            metavar="MODULE",
            help="Load a plugin from a local module: an importable name or a .py file. Repeatable.",
        ),
        click.option(
            "-q",
            "--quiet",
            is_flag=True,
            expose_value=False,
            callback=_speak,
            help="Print only the requested output.",
        ),
        click.option(
            "-v",
            "--verbose",
            count=True,
            expose_value=False,
            callback=_speak,
            help="Increase verbosity (-vv: debug).",
        ),
    ):
        function = option(function)
    return function


def _diverting(function: F) -> F:
    @functools.wraps(function)
    def diverting(*args: Any, **kwargs: Any) -> Any:
        with divert_plugin_text():
            return function(*args, **kwargs)

    return cast("F", diverting)


def output() -> Console:
    """Return the console for tables: names are printed literally, and only a terminal limits the width."""
    file = requested_output()
    console = Console(file=file, markup=False, emoji=False, highlight=False)
    if console.is_terminal:
        return console
    return Console(file=file, markup=False, emoji=False, highlight=False, width=4096)


def messages() -> Console:
    """Return the console for progress on standard error."""
    return Console(
        stderr=True, markup=False, emoji=False, highlight=False, force_terminal=sys.stderr.isatty()
    )


def scored(score: float | None, unit: str) -> str:
    """Return a score with its *unit*, as displayed."""
    return "diverged" if score is None else quantity(score, unit)


def span(window: tuple[float, float] | None) -> str:
    """Return the times between which a score is measured, as displayed; ``-`` for none."""
    return "-" if window is None else f"{window[0]:.3g} s to {window[1]:.3g} s"


def warn_overlooked(
    ctx: click.Context, source: object, config: RunConfig, designs: Sequence[Design], scores: Sequence[Score]
) -> None:
    """Warn if designs of a *source* are simulated for longer than their objective looks at."""
    from evoframe.designs import overlooked

    found = overlooked(config, designs, scores)
    if found is not None and not is_quiet(ctx):
        click.echo(f"Warning: {source}: the objective '{config.objective.name}' {found}", err=True)


def warn_unreproduced(ctx: click.Context, run: Run, config: RunConfig, then: float, now: Score) -> None:
    """Warn if the champion of a run does not have its score any more, because the bit generation changed."""
    from evoframe.record import changed_scoring

    changes = changed_scoring(run, config)
    if changes and now.value != then and not is_quiet(ctx):
        click.echo(f"Warning: {run.directory}: scored {then!r} in the run; {changes}", err=True)


def is_quiet(ctx: click.Context) -> bool:
    """Return whether only the requested output is printed (``-q``)."""
    return _common(ctx).verbosity < 0


def modules_of(ctx: click.Context) -> tuple[str, ...]:
    """Return the local plugins given with ``-p``, for other processes to load."""
    return tuple(_common(ctx).modules)


def command(ctx: click.Context, *words: object) -> str:
    """Return a command for a user to type next, with the ``-p`` options of this invocation."""
    return " ".join(filter(None, [shlex.join(["evoframe", *map(str, words)]), plugin_options(ctx)]))


def plugin_options(ctx: click.Context) -> str:
    """Return the ``-p`` options of this invocation as text; empty if there are none."""
    return shlex.join(part for module in modules_of(ctx) for part in ("-p", module))


def plugins_of(ctx: click.Context) -> Plugins:
    """Return the plugins, discovered once per invocation."""
    from evoframe.registry import discover

    common = _common(ctx)
    if common.plugins is None:
        with divert_plugin_text():
            common.plugins = discover(common.modules)
    return common.plugins


def _complete_preset(_: click.Context, __: click.Parameter, incomplete: str) -> list[CompletionItem]:
    from evoframe.config import preset_names

    presets = [CompletionItem(name) for name in preset_names() if name.startswith(incomplete)]
    return [*presets, CompletionItem(incomplete, type="file")]


def read_preset(_: click.Context, __: click.Parameter, preset: str | None) -> Layers | None:
    """Return the settings of a preset or TOML file, read once: it may be a pipe."""
    from evoframe.config import read_layers

    return None if preset is None else read_layers(preset)


def configuration_argument(function: F) -> F:
    """Add the argument for a preset or a configuration file."""
    return click.argument(
        "source", metavar="[CONFIG|PRESET]", default="paper", shell_complete=_complete_preset
    )(function)


def preset_option(function: F) -> F:
    """Add ``--preset P`` to a command that takes files, passed on as its layers of settings."""
    return click.option(
        "--preset",
        callback=read_preset,
        metavar="P",
        shell_complete=_complete_preset,
        help="Preset (or TOML file) for settings that the file does not contain, and for the objective. With "
        "a run, replaces the run's settings.  [default: the run's settings; paper for other files]",
    )(function)


def set_option(function: F) -> F:
    """Add ``--set key=value``."""
    return click.option(
        "--set",
        "overrides",
        multiple=True,
        metavar="KEY=VALUE",
        help="Override a setting. The value is TOML; a bare word is a string. Repeatable.",
    )(function)


def correction_option(function: F) -> F:
    """Add ``--correction C`` to a command that compares pairs of groups."""
    from evoframe.analysis.statistics.corrections import CORRECTIONS

    return click.option(
        "--correction",
        type=click.Choice(CORRECTIONS),
        default="holm",
        show_default=True,
        help="Correction of pairwise p-values for multiple comparisons (the paper uses none).",
    )(function)


@contextmanager
def needing_extra(extra: str, what: str) -> Iterator[None]:
    """Turn a failed import of an optional dependency into an error that names the extra to install.

    Args:
        extra: The extra that contains the dependency.
        what: Its purpose, for the message.

    Raises:
        InputError: A module is not installed.
    """
    try:
        yield
    except ModuleNotFoundError as error:
        name = str(error.name).partition(".")[0]
        raise InputError(
            f"{what} require the package {name}, which is not installed; in a checkout of evoframe, run: "
            f"pip install '.[{extra}]'"
        ) from error


def _workers_layer(_: click.Context, __: click.Parameter, workers: int | None) -> list[Layer]:
    from evoframe.config import layer_of

    return [] if workers is None else [layer_of(f"--workers {workers}", "executor.workers", workers)]


def workers_option(function: F) -> F:
    """Add ``--workers N``, passed on as layers of settings."""
    return click.option(
        "--workers",
        type=click.IntRange(min=0),
        callback=_workers_layer,
        metavar="N",
        help="Number of parallel simulations (0: one per core); does not change the results.",
    )(function)
