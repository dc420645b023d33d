"""Execution of a run by a worker process of a study."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import attrs

from evoframe.config import Layer, Layers, layer_of, resolve_layers
from evoframe.contract import Turn
from evoframe.errors import NotEmptyError, OccupiedError
from evoframe.record import CONFIG_FILE, Run, open_run
from evoframe.registry import Plugins, discover, hookimpl
from evoframe.runs import Execution, configuration_of, is_finished, prepare, reopen, verify_if_missing
from evoframe.study.progress import with_remedy

__all__ = ["INTERVAL", "Channel", "Order", "perform"]

INTERVAL = 0.25
"""Interval of a run's progress reports, and of polling for them, s."""


@attrs.frozen
class Order:
    """A run to execute.

    Attributes:
        directory: The run's directory.
        layers: The run's configuration.
        label: Name of the study.
        modules: Local plugins.
    """

    directory: Path
    layers: Layers
    label: str
    modules: tuple[str, ...]


@attrs.frozen
class Channel:
    """Connection between a worker and the process that started it, for one run.

    Attributes:
        report: Sends the latest turn, and the best score since the run started or resumed.
        stop: Returns whether to stop after the turn in progress.
        begin: Called when the run is open, and about to be played or verified.
    """

    report: Callable[[int, float | None], None]
    stop: Callable[[], bool]
    begin: Callable[[], None]


def perform(order: Order, channel: Channel) -> Run | None:
    """Start or resume a run, and verify its champion.

    Returns:
        The finished run; ``None`` if it was stopped.

    Raises:
        LockedError: Another process executes the run.
        EvoframeError: The run cannot be started, resumed or verified.
    """
    plugins = discover(order.modules)
    executor: Any = type(resolve_layers(order.layers, order.label, plugins).executor.component)
    spreads = "workers" in attrs.fields_dict(executor)
    # One core for each run: the study's other workers occupy the other cores.
    alone = [layer_of("one worker for each run", "executor.workers", 1)] if spreads else []
    execution = _start(order, alone, plugins)
    if execution is None:
        with open_run(order.directory) as run:
            if is_finished(run):
                channel.begin()
                verify_if_missing(run, configuration_of(run, alone, plugins))
                return run
            execution = reopen(run, alone, plugins)
    execution.plugins.manager.register(_Reporter(channel), name="evoframe:study")
    channel.begin()
    played = execution.play(channel.stop)
    if not played.finished():
        return None
    execution.verify(played)
    return played


def _start(order: Order, alone: Sequence[Layer], plugins: Plugins) -> Execution | None:
    """Return a new run; ``None`` if the directory has one already."""
    if (order.directory / CONFIG_FILE).exists():
        return None
    config = resolve_layers(order.layers.under(alone), order.label, plugins)
    with with_remedy():
        try:
            return prepare(config, plugins, order.directory)
        except OccupiedError:  # another process started it just now
            return None
        except NotEmptyError as error:
            # The directory of a study's run is fixed, so the original hint to choose another does not apply.
            raise NotEmptyError("directory is not empty", source=order.directory) from error


class _Reporter:
    """Reports finished turns, at most once per interval."""

    def __init__(self, channel: Channel) -> None:
        self._channel = channel
        self._best: float | None = None
        self._reported = -math.inf

    @hookimpl
    def evoframe_turn_finished(self, turn: Turn) -> None:
        if turn.best_pair is not None:
            self._best = turn.best_pair.score
        now = time.monotonic()
        if now - self._reported >= INTERVAL:
            self._reported = now
            self._channel.report(turn.index, self._best)
