"""Workers of a study: runs are resumed by others, progress is reported, and failures have a cause."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from concurrent.futures import Future
from pathlib import Path

import pytest
import toys
from processes import LIMIT

from evoframe import RunError, WorkerError, load_run
from evoframe.study.plan import Study
from evoframe.study.pool import End, Pool, end_of
from evoframe.study.worker import Order

Read = Callable[..., Study]


@pytest.fixture
def orders(toy_study: Read, tmp_path: Path) -> list[Order]:
    study = toy_study()
    return [
        Order(run.directory, study.layers_of(run), study.label, (toys.__file__,))
        for run in study.planned(tmp_path / "there")
    ]


def test_runs_are_executed_and_report_their_progress(orders: list[Order]) -> None:
    with contextlib.closing(Pool(2, [toys.__file__])) as pool:
        ends = [end_of(pool.start(order)) for order in orders[:2]]
        news = list(pool.news())
    assert [end.state for end in ends] == ["finished"] * 2
    assert [end.score for end in ends] == [
        load_run(order.directory).summary()["best_pair_score"] for order in orders[:2]
    ]
    assert {directory for directory, _, _ in news} == {order.directory for order in orders[:2]}
    assert all(turn >= 0 and best is not None for _, turn, best in news)


def test_a_requested_stop_reaches_runs_that_start_later(orders: list[Order]) -> None:
    with contextlib.closing(Pool(1, [toys.__file__])) as pool:
        pool.request_stop()
        pool.request_stop()
        assert pool.start(orders[0]).result(LIMIT) == End("stopped")


def test_a_run_whose_workers_cannot_start_fails_with_the_cause(orders: list[Order]) -> None:
    with contextlib.closing(Pool(1, ["no_such_plugin"])) as pool:
        for order in orders[:2]:  # the second has new workers
            end = end_of(pool.start(order))
            assert end.state == "failed"
            assert "no_such_plugin" in end.cause


@pytest.mark.parametrize("error", [WorkerError("its workers ended", ("an order",)), RunError("none started")])
def test_work_without_a_worker_has_failed(error: RunError) -> None:
    future: Future[End] = Future()
    future.set_exception(error)
    assert end_of(future) == End("failed", error.problem)
