"""Messages between processes: each arrives whole or not at all, whatever happens to the other end."""

from __future__ import annotations

import socket
import threading
import time
from collections.abc import Iterator
from typing import Any

import pytest
from hypothesis import given, settings, strategies as st

from evoframe.workers.channel import Channel

MESSAGES = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | st.text() | st.binary(),
    lambda inner: st.lists(inner) | st.tuples(inner, inner) | st.dictionaries(st.text(), inner),
)
LARGE = bytes(5_000_000)  # larger than the buffers of a connection


@pytest.fixture
def ends() -> Iterator[tuple[Channel, socket.socket]]:
    here, there = socket.socketpair()
    channel = Channel(here)
    with there:
        yield channel, there
    channel.close()


@given(st.lists(MESSAGES, max_size=5))
def test_messages_arrive_in_order_and_unchanged(messages: list[Any]) -> None:
    here, there = map(Channel, socket.socketpair())
    for message in messages:
        here.send(message)
    here.shutdown()  # what has been sent can still be received
    assert [there.receive() for _ in messages] == messages
    with pytest.raises(EOFError):
        there.receive()
    here.close()
    there.close()


def test_a_message_larger_than_all_buffers_arrives(ends: tuple[Channel, socket.socket]) -> None:
    channel, there = ends
    sender = threading.Thread(target=Channel(there).send, args=[LARGE])
    sender.start()
    assert channel.receive() == LARGE
    sender.join()


@settings(max_examples=50)
@given(st.data())
def test_a_message_that_breaks_off_anywhere_is_not_received(data: st.DataObject) -> None:
    packed = Channel.pack({"a": list(range(50))})
    whole = len(packed).to_bytes(8, "big") + packed
    here, there = socket.socketpair()
    with there:
        there.sendall(whole[: data.draw(st.integers(0, len(whole) - 1))])
    channel = Channel(here)
    with pytest.raises(EOFError):
        channel.receive()
    channel.close()


def test_nothing_is_sent_to_a_closed_end(ends: tuple[Channel, socket.socket]) -> None:
    channel, there = ends
    there.close()
    with pytest.raises(EOFError):
        channel.send(LARGE)


def test_the_other_end_may_stop_reading_or_writing_at_any_byte(ends: tuple[Channel, socket.socket]) -> None:
    channel, there = ends
    there.sendall(bytes(7))  # of a header of 8 bytes
    for action in (channel.receive, lambda deadline: channel.send(LARGE, deadline)):
        with pytest.raises(TimeoutError):
            action(time.monotonic() + 0.01)
        with pytest.raises(TimeoutError):
            action(time.monotonic() - 1.0)


def test_an_object_that_cannot_be_pickled_leaves_the_connection_usable(
    ends: tuple[Channel, socket.socket],
) -> None:
    channel, there = ends
    with pytest.raises((AttributeError, TypeError)):
        channel.send(threading.Lock())
    channel.send(1)
    assert Channel(there).receive() == 1


def test_another_thread_ends_a_wait(ends: tuple[Channel, socket.socket]) -> None:
    channel, _ = ends
    threading.Timer(0.01, channel.shutdown).start()
    with pytest.raises(EOFError):
        channel.receive()
    channel.close()
    channel.shutdown()  # does nothing
