"""What a process of a study does: one run after the other, each from where it was left."""

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

__all__ = ["INTERVAL", "Order", "Talk", "perform"]

INTERVAL = 0.25
"""Seconds between two things that are told of a run, and between two looks at what was told."""


@attrs.frozen
class Order:
    """One run that shall be made.

    Attributes:
        directory: Where to.
        layers: Its configuration.
        label: What a person calls the study.
        modules: Local plugins.
    """

    directory: Path
    layers: Layers
    label: str
    modules: tuple[str, ...]


@attrs.frozen
class Talk:
    """How a process of a study and the one that started it talk about a run.

    Attributes:
        tell: Takes the latest turn, and the best score since work on the run began.
        stop: Says whether to stop after the turn in progress.
    """

    tell: Callable[[int, float | None], None]
    stop: Callable[[], bool]


def perform(order: Order, talk: Talk) -> Run | None:
    """Begin a run, or go on with it, and verify its champion.

    Returns:
        The finished run; ``None`` if it was stopped.

    Raises:
        LockedError: Another process is at it.
        EvoframeError: It cannot be made, cannot go on, or cannot be verified.
    """
    plugins = discover(order.modules)
    executor: Any = type(resolve_layers(order.layers, order.label, plugins).executor.component)
    spreads = "workers" in attrs.fields_dict(executor)
    # One core for each run: the others have runs of their own.
    alone = [layer_of("one worker for each run", "executor.workers", 1)] if spreads else []
    execution = _begun(order, alone, plugins)
    if execution is None:
        with open_run(order.directory) as run:
            if is_finished(run):
                verify_if_missing(run, configuration_of(run, alone, plugins))
                return run
            execution = reopen(run, alone, plugins)
    execution.plugins.manager.register(_Teller(talk), name="evoframe:study")
    played = execution.play(talk.stop)
    if not played.finished():
        return None
    execution.verify(played)
    return played


def _begun(order: Order, alone: Sequence[Layer], plugins: Plugins) -> Execution | None:
    """Return a new run; ``None`` if there is one already."""
    if (order.directory / CONFIG_FILE).exists():
        return None
    config = resolve_layers(order.layers.under(alone), order.label, plugins)
    with with_remedy():
        try:
            return prepare(config, plugins, order.directory)
        except OccupiedError:  # by another process, a moment ago
            return None
        except NotEmptyError as error:
            # A run of a study has its place: it is no help that another directory could be chosen.
            raise NotEmptyError(f"{order.directory}: is not empty") from error


class _Teller:
    """Tells of the turns, but not more often than anybody looks."""

    def __init__(self, talk: Talk) -> None:
        self._talk = talk
        self._best: float | None = None
        self._told = -math.inf

    @hookimpl
    def evoframe_turn_finished(self, turn: Turn) -> None:
        if turn.best_pair is not None:
            self._best = turn.best_pair.score
        now = time.monotonic()
        if now - self._told >= INTERVAL:
            self._told = now
            self._talk.tell(turn.index, self._best)
