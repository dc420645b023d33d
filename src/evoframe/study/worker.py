"""What a process of a study does: one run after the other, each from where it was left."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import attrs

from evoframe.config.layers import Layer, Layers, layer_of
from evoframe.config.resolve import resolved
from evoframe.contract.config import RunConfig
from evoframe.contract.values import Turn
from evoframe.errors import InputError, LockedError, NotEmptyError, OccupiedError
from evoframe.record.layout import CONFIG_FILE
from evoframe.record.run import open_run
from evoframe.registry.discovery import discover
from evoframe.registry.hookspecs import hookimpl
from evoframe.registry.registry import Plugins
from evoframe.runs.execution import Execution
from evoframe.runs.resuming import configuration_of, is_finished, reopen, verify_if_missing
from evoframe.runs.starting import prepare
from evoframe.study.progress import REMEDY

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


def perform(order: Order, talk: Talk) -> bool:
    """Begin a run, or go on with it, and verify its champion; return whether it came to its end.

    Raises:
        LockedError: Another process is at it.
        EvoframeError: It cannot be made, cannot go on, or cannot be verified.
    """
    plugins = discover(order.modules)
    alone = _alone(resolved(order.layers, order.label, plugins))
    execution = _begun(order, alone, plugins) or _reopened(order, alone, plugins)
    if execution is None:
        return True
    execution.plugins.manager.register(_Teller(talk), name="evoframe:study")
    run = execution.play(talk.stop)
    if run.finished():
        execution.verify(run)
    return run.finished()


def _reopened(order: Order, alone: Sequence[Layer], plugins: Plugins) -> Execution | None:
    """Return the run that is there, ready to go on; ``None`` if it is finished, and verified now."""
    with open_run(order.directory) as run:
        if not is_finished(run):
            return reopen(run, alone, plugins)
        verify_if_missing(run, configuration_of(run, alone, plugins))
    return None


def _begun(order: Order, alone: Sequence[Layer], plugins: Plugins) -> Execution | None:
    """Return a new run; ``None`` if there is one already."""
    if (order.directory / CONFIG_FILE).exists():
        return None
    try:
        return prepare(resolved(order.layers.under(alone), order.label, plugins), plugins, order.directory)
    except OccupiedError:  # by another process, a moment ago
        return None
    except LockedError:
        raise
    except InputError as error:
        # A run of a study has its place: it is no help that another directory could be chosen.
        what = f"{order.directory}: is not empty" if isinstance(error, NotEmptyError) else error
        raise InputError(f"{what}; {REMEDY}") from error


def _alone(config: RunConfig) -> list[Layer]:
    """Return what lets the executor work on one core: the others have runs of their own."""
    component: Any = type(config.executor.component)
    if "workers" not in attrs.fields_dict(component):
        return []
    return [layer_of("one worker for each run", "executor.workers", 1)]


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
