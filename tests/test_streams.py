"""Streams that never raise, over files of all kinds."""

from __future__ import annotations

import errno
import io
import os
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import click
import pytest
from hypothesis import given, strategies as st
from processes import python

from evoframe.streams import StandardStream, make_unfailing


@pytest.fixture
def file(tmp_path: Path) -> Iterator[io.FileIO]:
    with (tmp_path / "text").open("wb", buffering=0) as opened:
        yield opened


ENCODINGS = ["ascii", "us-ascii", "646", "latin-1", "cp1252", "utf-8", "shift-jis"]


@given(
    text=st.text(st.characters()),
    encoding=st.sampled_from(ENCODINGS),
    errors=st.sampled_from([None, "strict", "surrogateescape"]),
)
def test_every_text_is_written_escaped_where_necessary(text: str, encoding: str, errors: str | None) -> None:
    read, write = os.pipe()
    with open(write, "wb", buffering=0) as raw:  # noqa: PTH123 - a descriptor
        stream = StandardStream(raw, encoding, errors)
        assert stream.write(text) == len(text)
        stream.finish()
    with open(read, "rb") as written:  # noqa: PTH123 - a descriptor
        assert written.read() == text.replace("\n", os.linesep).encode(encoding, "backslashreplace")
    assert stream.failure is None


def test_an_error_handler_that_cannot_fail_is_kept(file: io.FileIO) -> None:
    stream = StandardStream(file, "ascii", "replace")
    stream.write("ü")
    assert Path(os.fsdecode(file.name)).read_bytes() == b"?"


def test_click_escapes_too(file: io.FileIO, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stdout", StandardStream(file, "ascii"))
    click.echo("ü")
    click.echo(b"\xfc")
    assert Path(os.fsdecode(file.name)).read_bytes() == b"\\xfc\n\xfc\n"


def test_a_missing_stream_keeps_the_failure_only_after_a_text() -> None:
    stream = StandardStream(None)
    stream.flush()
    stream.write("")
    assert stream.failure is None
    assert not stream.isatty()
    with pytest.raises(io.UnsupportedOperation):
        stream.fileno()
    stream.write("lost")
    assert stream.failure is not None
    assert stream.failure.errno == errno.EBADF


def test_a_broken_pipe_is_kept_as_the_failure() -> None:
    read, write = os.pipe()
    os.close(read)
    with open(write, "wb", buffering=0) as raw:  # noqa: PTH123 - a descriptor
        stream = StandardStream(raw)
        stream.write("lost")
        stream.write("lost too")
        assert stream.failure is not None
        assert stream.failure.errno == errno.EPIPE


def test_a_pipe_that_does_not_block_receives_everything() -> None:
    read, write = os.pipe()
    os.set_blocking(write, False)
    text = "0123456789" * 100_000
    received: list[bytes] = []

    def receive() -> None:
        with open(read, "rb") as pipe:  # noqa: PTH123 - a descriptor
            received.append(pipe.read())

    reader = threading.Thread(target=receive)
    reader.start()
    with open(write, "wb", buffering=0) as raw:  # noqa: PTH123 - a descriptor
        stream = StandardStream(raw)
        stream.write(text)
        stream.finish()
    reader.join()
    assert stream.failure is None
    assert received == [text.encode()]


class _FullAtLast(io.FileIO):
    def close(self) -> None:
        if not self.closed:
            super().close()
            raise OSError(errno.EDQUOT, os.strerror(errno.EDQUOT))


def test_a_failure_on_closing_is_kept(tmp_path: Path) -> None:
    stream = StandardStream(_FullAtLast(tmp_path / "text", "w"))
    stream.write("lost by the server")
    assert stream.failure is None
    stream.finish()
    stream.finish()
    assert stream.failure is not None
    assert stream.failure.errno == errno.EDQUOT


def test_a_stream_that_is_not_a_file_remains(monkeypatch: pytest.MonkeyPatch) -> None:
    text, missing = io.StringIO(), io.StringIO()
    missing.close()
    monkeypatch.setattr(sys, "stdout", text)
    monkeypatch.setattr(sys, "stderr", missing)
    make_unfailing()
    assert sys.stdout is text
    assert isinstance(sys.stderr, StandardStream)


@pytest.mark.skipif(not hasattr(os, "dup2"), reason="needs descriptors")
def test_a_file_does_not_take_the_place_of_a_closed_stream() -> None:
    program = (
        "import os\n"
        "from evoframe.streams import open_missing\n"
        "for number in (0, 1, 2): os.close(number)\n"
        "open_missing()\n"
        "os._exit(os.open(os.devnull, os.O_RDONLY) if all(map(os.get_inheritable, (0, 1, 2))) else 0)\n"
    )
    assert python("-c", program).returncode == 3
