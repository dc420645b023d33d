"""Options that executors share: their ranges, and their names in messages."""

import pytest
from hypothesis import given, strategies as st

from evoframe_executors import Processes, Threads
from evoframe_executors.options import overdue

EITHER = pytest.mark.parametrize("executor", [Processes, Threads])


def test_a_negative_number_of_workers_is_refused() -> None:
    with pytest.raises(ValueError, match=r"'workers' .*>= 0: -1"):
        Threads(workers=-1)


@pytest.mark.parametrize("limit", [0.0, -1.0, float("nan")])
@EITHER
def test_a_time_limit_is_positive(executor: type[Processes] | type[Threads], limit: float) -> None:
    with pytest.raises(ValueError, match=r"'batch_time_limit' .*> 0"):
        executor(batch_time_limit=limit)


@EITHER
@given(workers=st.integers(0, 1024), limit=st.none() | st.floats(5e-324, 1e308))
def test_values_in_range_are_accepted(
    executor: type[Processes] | type[Threads], workers: int, limit: float | None
) -> None:
    made = executor(workers=workers, batch_time_limit=limit)
    assert (made.workers, made.batch_time_limit) == (workers, limit)


@EITHER
@given(workers=st.integers(max_value=-1) | st.integers(min_value=1025))
def test_a_number_of_workers_out_of_range_is_refused(
    executor: type[Processes] | type[Threads], workers: int
) -> None:
    with pytest.raises(ValueError, match="'workers'"):
        executor(workers=workers)


def test_a_message_names_the_option_and_its_value() -> None:
    assert "executor.batch_time_limit = 2.5 s" in overdue(2.5)
