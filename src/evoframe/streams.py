"""Standard streams that never raise: characters are escaped if necessary, and a failure is kept for later."""

from __future__ import annotations

import codecs
import contextlib
import errno
import io
import os
import select
import sys
from collections.abc import Callable
from typing import Any, TextIO

__all__ = ["StandardStream", "make_unfailing", "open_missing"]

_NEVER_FAIL = frozenset({"backslashreplace", "ignore", "namereplace", "replace", "xmlcharrefreplace"})
"""Error handlers that encode every text; any other is replaced by the first."""

_ASCII = "evoframe_ascii"
"""ASCII under another name: click writes UTF-8 to a stream whose encoding is called ASCII."""


class StandardStream(io.TextIOWrapper):
    """A text stream whose methods do not raise; text after a failure is discarded.

    Args:
        raw: Unbuffered file to write to; ``None`` if the stream is closed or missing.
        encoding: Encoding.
        errors: Error handler; one that can fail is replaced.
    """

    def __init__(self, raw: io.RawIOBase | None, encoding: str = "utf-8", errors: str | None = None) -> None:
        self._sink = _Sink(raw)
        if codecs.lookup(encoding).name == "ascii":
            encoding = _ASCII
        handler = errors if errors in _NEVER_FAIL else "backslashreplace"
        # Unbuffered, because a signal handler may print while this stream is printing.
        super().__init__(self._sink, encoding, handler, write_through=True)  # type: ignore[arg-type]

    @property
    def failure(self) -> OSError | None:
        """The error because of which text was discarded."""
        return self._sink.failure

    def lend(self, descriptor: int) -> None:
        """Make *descriptor* refer to the file of this stream, if it has one."""
        if self._sink.raw is not None:
            os.dup2(self._sink.raw.fileno(), descriptor)

    def finish(self) -> None:
        """Close the file of this stream, which can report a failure too."""
        if self._sink.raw is not None:
            try:
                self._sink.raw.close()
            except OSError as error:
                self._sink.failure = self._sink.failure or error
            self._sink.raw = None


class _Sink(io.RawIOBase):
    """A file that accepts everything.

    Attributes:
        raw: The file to write to.
        failure: The first error.
    """

    def __init__(self, raw: io.RawIOBase | None) -> None:
        self.raw = raw
        self.failure: OSError | None = None

    def writable(self) -> bool:
        return True

    def isatty(self) -> bool:
        return self.raw is not None and self.raw.isatty()

    def fileno(self) -> int:
        if self.raw is None:
            raise io.UnsupportedOperation("the stream is closed")
        return self.raw.fileno()

    def write(self, data: Any) -> int:
        """Write all of *data*, or discard it."""
        left = memoryview(data).cast("B")
        size = len(left)
        try:
            while left and self.failure is None:
                left = left[self._written(left) :]
        except OSError as error:
            self.failure = error
        return size

    def _written(self, data: memoryview) -> int:
        """Write at least a part of *data*; return its size."""
        if self.raw is None:
            raise OSError(errno.EBADF, "it is closed")
        while (written := self.raw.write(data)) is None:  # a pipe that another program made non-blocking
            select.select([], [self.raw], [])
        return written


def open_missing() -> None:
    """Open standard descriptors that are closed, since the next file opened would receive their text."""
    for descriptor in range(3):
        try:
            os.fstat(descriptor)
        except OSError:
            os.open(os.devnull, os.O_RDONLY if descriptor == 0 else os.O_WRONLY)  # the lowest free number
            os.set_inheritable(descriptor, True)  # noqa: FBT003 - takes no keywords


def make_unfailing(duplicate: Callable[[int], int] | None = None) -> None:
    """Replace ``sys.stdout`` and ``sys.stderr`` by streams that never raise; others than files remain.

    Args:
        duplicate: Returns the descriptor that standard output writes to from now on; by default its own.
    """
    sys.stdout = _unfailing(sys.stdout, duplicate)
    sys.stderr = _unfailing(sys.stderr, None)


def _unfailing(stream: TextIO | None, duplicate: Callable[[int], int] | None) -> TextIO:
    if stream is None or stream.closed:
        return StandardStream(None)
    try:
        descriptor = stream.fileno()
    except (AttributeError, OSError):  # not a file: the stream of a program that calls evoframe
        return stream
    with contextlib.suppress(OSError):
        stream.flush()
    owned = duplicate is not None
    number = duplicate(descriptor) if duplicate is not None else descriptor
    raw = open(number, "wb", buffering=0, closefd=owned)  # noqa: SIM115 - a descriptor, kept open
    return StandardStream(raw, stream.encoding, stream.errors)


def _find_codec(name: str) -> codecs.CodecInfo | None:
    if name != _ASCII:
        return None
    info = codecs.lookup("ascii")
    return codecs.CodecInfo(
        info.encode,
        info.decode,
        streamreader=info.streamreader,
        streamwriter=info.streamwriter,
        incrementalencoder=info.incrementalencoder,
        incrementaldecoder=info.incrementaldecoder,
        name=_ASCII,
    )


codecs.register(_find_codec)
