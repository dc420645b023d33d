"""What a worker process does, and the parcels of bytes that pass between it and the process that asks.

The parcels are made as :mod:`multiprocessing` makes its own. Nothing but these processes sees them.
"""

from __future__ import annotations

import traceback
from collections.abc import Callable
from multiprocessing.reduction import ForkingPickler
from typing import Any

import attrs

from evoframe import RunError

__all__ = ["Answer", "answered", "packed", "unpacked"]


@attrs.frozen
class Answer:
    """What came of a function.

    Attributes:
        succeeded: Whether it returned something; otherwise it raised something.
        parcel: What it returned or raised.
    """

    succeeded: bool
    parcel: bytes


def packed(function: Callable[[Any], Any], item: Any) -> bytes:
    """Return a parcel for :func:`answered`.

    Raises:
        RunError: One of both cannot be sent to another process.
    """
    try:
        return _packed((function, item))
    except Exception as error:
        raise _cannot_travel("what a worker shall do cannot be sent to it", error) from error


def answered(parcel: bytes) -> Answer:
    """Return what comes of a function and an item, in a worker process."""
    try:
        function, item = ForkingPickler.loads(parcel)
    except Exception as error:  # noqa: BLE001 - raised by the process that asks
        return _untravelled("a worker does not know what it shall do", error)
    try:
        result = function(item)
    except BaseException as error:  # noqa: BLE001 - raised by the process that asks
        return _failure(error)
    try:
        return Answer(succeeded=True, parcel=_packed(result))
    except Exception as error:  # noqa: BLE001 - raised by the process that asks
        return _untravelled("a result cannot be sent back", error)


def unpacked(answer: Answer) -> Any:
    """Return what a function returned, or raise what it raised."""
    content = ForkingPickler.loads(answer.parcel)
    if answer.succeeded:
        return content
    raise content


def _packed(content: Any) -> bytes:
    return bytes(ForkingPickler.dumps(content))


def _failure(error: BaseException) -> Answer:
    """Return an error as an answer, with its traceback, which would be lost; as text, if it cannot travel."""
    error.add_note("In a worker process:\n" + "".join(traceback.format_exception(error)))
    try:
        ForkingPickler.loads(parcel := _packed(error))
    except Exception:  # noqa: BLE001 - many exceptions cannot be made again from their arguments
        parcel = _packed(RunError(f"{type(error).__name__}: {error}"))
    return Answer(succeeded=False, parcel=parcel)


def _untravelled(what: str, error: Exception) -> Answer:
    return Answer(succeeded=False, parcel=_packed(_cannot_travel(what, error)))


def _cannot_travel(what: str, error: Exception) -> RunError:
    cause = f"{type(error).__name__}: {error}"
    todo = "simulators and objectives of a file given with -p, for example, work with 'threads' only"
    return RunError(f"executor 'processes': {what}: {cause}; {todo}")
