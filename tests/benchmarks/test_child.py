"""A child process replies to requests, and its failures have its name."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from benchmarks.child import CHILDREN, Child, started
from benchmarks.report import SectionError

PROGRAM = f"""
import os, sys
sys.path.insert(0, {str(CHILDREN)!r})
from serving import serve
def double(number):
    print("not a reply")
    os.write(1, b"not a reply, either")
    return 2 * number
def stop():
    sys.exit("stopped on request")
variable = lambda: os.environ["OF_THE_CHILD"]
serve({{"double": double, "stop": stop, "fail": lambda: 1 / 0, "variable": variable}})
"""


@pytest.fixture
def child() -> Iterator[Child]:
    with started("the child", [sys.executable, "-c", PROGRAM], {"OF_THE_CHILD": "7"}) as process:
        yield process


def test_requests_are_answered_in_order(child: Child) -> None:
    assert [child.ask("double", number=number) for number in (1, 2.5, 4)] == [2, 5.0, 8]


def test_it_has_variables_of_its_own(child: Child) -> None:
    assert child.ask("variable") == "7"


def test_after_an_error_it_continues(child: Child) -> None:
    with pytest.raises(SectionError, match="the child cannot fail: ZeroDivisionError"):
        child.ask("fail")
    assert child.ask("double", number=1) == 2


def test_the_end_of_the_process_is_an_error(child: Child) -> None:
    with pytest.raises(SectionError, match="the child ended with exit code 1: stopped on request"):
        child.ask("stop")
    with pytest.raises(SectionError, match="exit code 1"):
        child.ask("double", number=1)


def test_a_missing_program_is_an_error(tmp_path: Path) -> None:
    command = [str(tmp_path / "missing")]
    with pytest.raises(SectionError, match="No such file"), started("the child", command, {}):
        pass
