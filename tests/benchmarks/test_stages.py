"""The stages of a program are measured by wrappers around its methods."""

import threading
import time

import pytest

from benchmarks.stages import Stages


class Work:
    """A program that spends CPU time."""

    def outer(self) -> str:
        self.inner()
        return "done"

    def inner(self) -> None:
        end = time.thread_time() + 0.02
        while time.thread_time() < end:
            pass

    def fail(self) -> None:
        raise ValueError


METHODS = [(Work, "outer", "outer"), (Work, "inner", "inner"), (Work, "fail", "failing")]


def test_measured_methods_work_as_before() -> None:
    original = Work.outer
    with Stages().watch(METHODS):
        assert Work().outer() == "done"
    assert Work.outer is original


def test_the_time_of_a_stage_excludes_its_inner_stages() -> None:
    stages = Stages()
    with stages.watch(METHODS):
        Work().outer()
    assert stages.calls == {"outer": 1, "inner": 1}
    assert stages.cpu["inner"] >= 0.02
    assert 0.0 <= stages.cpu["outer"] < stages.cpu["inner"]


def test_threads_add_up() -> None:
    stages, work = Stages(), Work()
    with stages.watch(METHODS):
        threads = [threading.Thread(target=work.inner) for _ in range(2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    assert stages.cpu["inner"] >= 0.04


def test_a_stage_that_fails_ends() -> None:
    stages = Stages()
    with stages.watch(METHODS):
        with pytest.raises(ValueError):  # noqa: PT011 - the one that fail() raises
            Work().fail()
        Work().outer()
    assert stages.calls == {"failing": 1, "outer": 1, "inner": 1}


@pytest.mark.parametrize(
    ("spans", "elapsed"),
    [
        ([], 0.0),
        ([(0.0, 1.0), (2.0, 4.0)], 3.0),
        ([(2.0, 4.0), (0.0, 3.0)], 4.0),
        ([(0.0, 5.0), (1.0, 2.0)], 5.0),
    ],
)
def test_overlapping_spans_count_once(spans: list[tuple[float, float]], elapsed: float) -> None:
    assert Stages(spans={"a": spans}).elapsed("a") == elapsed
    assert Stages(spans={"a": spans}).elapsed("b") == 0.0
