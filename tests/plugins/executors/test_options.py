"""Options that executors share: which numbers they take, and how a message names them."""

import pytest
from hypothesis import given, strategies as st

from evoframe_executors import Processes, Threads
from evoframe_executors.options import overdue

EITHER = pytest.mark.parametrize("executor", [Processes, Threads])


def test_a_negative_number_of_workers_is_refused() -> None:
    with pytest.raises(ValueError, match="'workers' must be >= 0: -1"):
        Threads(workers=-1)


@pytest.mark.parametrize("limit", [0.0, -1.0, float("nan")])
@EITHER
def test_a_time_limit_is_positive(executor: type[Processes] | type[Threads], limit: float) -> None:
    with pytest.raises(ValueError, match="'batch_time_limit' must be > 0"):
        executor(batch_time_limit=limit)


@EITHER
@given(workers=st.integers(0, 1024), limit=st.none() | st.floats(5e-324, 1e308))
def test_what_is_in_range_is_taken(
    executor: type[Processes] | type[Threads], workers: int, limit: float | None
) -> None:
    made = executor(workers=workers, batch_time_limit=limit)
    assert (made.workers, made.batch_time_limit) == (workers, limit)


@EITHER
@given(workers=st.integers(max_value=-1) | st.integers(min_value=1025))
def test_a_number_of_workers_out_of_range_is_refused(
    executor: type[Processes] | type[Threads], workers: int
) -> None:
    with pytest.raises(ValueError, match="'workers' must be"):
        executor(workers=workers)


def test_a_message_names_the_option() -> None:
    assert overdue(2.5) == "took longer than executor.batch_time_limit = 2.5 seconds"
