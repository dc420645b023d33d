"""Work of a worker process, and the parcels of bytes that it exchanges with the calling process.

Parcels are pickled as in :mod:`multiprocessing`, and are never read by any other process.
"""

from __future__ import annotations

import traceback
from collections.abc import Callable
from multiprocessing.reduction import ForkingPickler
from typing import Any

import attrs

from evoframe import RunError

__all__ = ["Answer", "Call", "execute", "pack", "unpack"]


@attrs.frozen
class Answer:
    """Result of a function call in a worker process.

    Attributes:
        succeeded: Whether the function returned a value; if not, it raised an exception.
        parcel: The returned value or the raised exception.
    """

    succeeded: bool
    parcel: bytes


@attrs.frozen
class Call:
    """A function and its item, in a parcel; unpickling it also opens the parcel, for :func:`execute`.

    Attributes:
        parcel: The function and the item.
    """

    parcel: bytes

    def __reduce__(self) -> tuple[Callable[[bytes], Any], tuple[bytes]]:
        return _opened, (self.parcel,)


def _opened(parcel: bytes) -> tuple[Callable[[Any], Any], Any] | Answer:
    """Return the function and the item in a parcel, or the answer that it cannot be opened."""
    try:
        function, item = ForkingPickler.loads(parcel)
    except Exception as error:  # noqa: BLE001 - raised in the calling process
        return _transfer_failure("cannot load a task in a worker process", error)
    return function, item


def pack(function: Callable[[Any], Any], item: Any) -> Call:
    """Return a call for a worker process.

    Raises:
        RunError: The function or the item cannot be pickled.
    """
    try:
        return Call(_pickle((function, item)))
    except Exception as error:
        raise _transfer_error("cannot send a task to a worker process", error) from error


def execute(call: tuple[Callable[[Any], Any], Any] | Answer) -> Answer:
    """Execute a call that has arrived in a worker process, and return its result."""
    if isinstance(call, Answer):
        return call
    function, item = call
    try:
        result = function(item)
    except BaseException as error:  # noqa: BLE001 - raised in the calling process
        return _failure(error)
    try:
        return Answer(succeeded=True, parcel=_pickle(result))
    except Exception as error:  # noqa: BLE001 - raised in the calling process
        return _transfer_failure("cannot return a result from a worker process", error)


def unpack(answer: Answer) -> Any:
    """Return the value that a function returned, or raise its exception."""
    content = ForkingPickler.loads(answer.parcel)
    if answer.succeeded:
        return content
    raise content


def _pickle(content: Any) -> bytes:
    return bytes(ForkingPickler.dumps(content))


def _failure(error: BaseException) -> Answer:
    """Return the answer for an exception, with its traceback as a note; as text if it cannot be pickled."""
    error.add_note("In a worker process:\n" + "".join(traceback.format_exception(error)))
    try:
        ForkingPickler.loads(parcel := _pickle(error))
    except Exception:  # noqa: BLE001 - many exceptions cannot be recreated from their arguments
        parcel = _pickle(RunError(f"{type(error).__name__}: {error}"))
    return Answer(succeeded=False, parcel=parcel)


def _transfer_failure(problem: str, error: Exception) -> Answer:
    return Answer(succeeded=False, parcel=_pickle(_transfer_error(problem, error)))


def _transfer_error(problem: str, error: Exception) -> RunError:
    cause = f"{type(error).__name__}: {error}"
    advice = "simulators and objectives of a plugin given with -p require --set executor=threads"
    return RunError(f"'processes' {problem}: {cause}; {advice}", key="executor")
