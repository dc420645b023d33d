"""Messages between a worker process and the process that started it."""

from __future__ import annotations

import contextlib
import socket
import struct
import time
from collections.abc import Iterator
from multiprocessing.reduction import ForkingPickler
from typing import Any

__all__ = ["Channel"]

_HEADER = struct.Struct("!Q")  # length of the message, bytes
_PIECE = 1 << 20  # largest read at once, bytes


class Channel:
    """One end of a connection between two processes of one program, which transmits whole objects.

    Nothing is shared with a third process: if a process is killed at any moment, only its own connection
    ends. Sending and receiving raise :class:`EOFError` if the other end is closed, and :class:`TimeoutError`
    after the deadline; the connection is unusable after either.

    Args:
        connection: A stream socket.
    """

    def __init__(self, connection: socket.socket) -> None:
        self._socket = connection

    def send(self, message: object, deadline: float | None = None) -> None:
        """Send an object that can be pickled; if it cannot, nothing is sent."""
        self.send_packed(self.pack(message), deadline)

    @staticmethod
    def pack(message: object) -> bytes:
        """Return the content of a message, pickled as in :mod:`multiprocessing`."""
        return bytes(ForkingPickler.dumps(message))

    @staticmethod
    def unpack(content: bytes) -> Any:
        """Return the object in a message."""
        return ForkingPickler.loads(content)

    def send_packed(self, content: bytes, deadline: float | None = None) -> None:
        """Send a message.

        Args:
            content: Its content, from :meth:`pack`.
            deadline: Latest end of the transmission, in the time of :func:`time.monotonic`.
        """
        with _other_end():
            self._limit(deadline)
            self._socket.sendall(_HEADER.pack(len(content)))
            self._limit(deadline)
            self._socket.sendall(content)

    def receive(self, deadline: float | None = None) -> Any:
        """Receive an object; the deadline is that of its last byte."""
        with _other_end():
            (length,) = _HEADER.unpack(self._read(_HEADER.size, deadline))
            content = self._read(length, deadline)
        return self.unpack(content)

    def shutdown(self) -> None:
        """End the connection from another thread; messages that have arrived can still be received."""
        with contextlib.suppress(OSError):  # closed, or the other end is
            self._socket.shutdown(socket.SHUT_RDWR)

    def close(self) -> None:
        """Close this end."""
        self._socket.close()

    def _read(self, length: int, deadline: float | None) -> bytes:
        content = bytearray()
        while len(content) < length:
            self._limit(deadline)
            piece = self._socket.recv(min(length - len(content), _PIECE))
            if not piece:
                raise EOFError
            content += piece
        return bytes(content)

    def _limit(self, deadline: float | None) -> None:
        left = None if deadline is None else deadline - time.monotonic()
        if left is not None and left <= 0.0:
            raise TimeoutError
        self._socket.settimeout(left)


@contextlib.contextmanager
def _other_end() -> Iterator[None]:
    """Report a closed connection in one way, whether it was noticed while reading or writing."""
    try:
        yield
    except ConnectionError as error:
        raise EOFError from error
