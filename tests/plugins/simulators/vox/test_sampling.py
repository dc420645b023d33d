"""Selection of sampled steps: the rule of the paper's engine in closed form."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, strategies as st

from evoframe import ConfigurationError, Record
from evoframe_simulators.vox.sampling import Clock, check_samples

time_steps = st.floats(1e-5, 1e-2)
step_counts = st.integers(1, 200)
intervals = st.floats(0, 0.1)
clocks = st.builds(Clock, time_steps, step_counts)


@given(clock=clocks, every=intervals, initial=st.booleans())
def test_samples_ascend_by_at_least_the_interval(clock: Clock, every: float, initial: bool) -> None:
    taken = clock.samples(Record((), every=every, initial=initial))
    assert taken[0] == (0 if initial else 1)
    taken = taken[1:] if initial else taken
    assert taken[0] == 1
    assert (np.diff(taken) >= 1).all()
    assert (np.diff(taken) * clock.time_step >= every * (1 - 1e-12) - 1e-12).all()
    assert taken[-1] <= clock.steps


@given(clock=clocks, every=intervals)
def test_every_step_that_is_due_is_sampled(clock: Clock, every: float) -> None:
    taken = clock.samples(Record((), every=every))
    gaps = np.diff([*taken, clock.steps + 1])
    assert ((gaps == 1) | ((gaps - 1) * clock.time_step < every)).all()


@given(time_step=time_steps, multiple=st.integers(1, 10**6))
def test_a_multiple_of_the_time_step_is_an_exact_interval(time_step: float, multiple: int) -> None:
    clock = Clock(time_step, multiple + 1)
    for every in (multiple * time_step, np.nextafter(multiple * time_step, np.inf)):
        assert clock.samples(Record((), every=every)).tolist() == [1, 1 + multiple]


@given(clock=clocks, every=intervals)
def test_the_count_equals_the_number_of_samples(clock: Clock, every: float) -> None:
    taken = clock.samples(Record((), every=every))
    assert clock.count(every) == len(taken)
    chosen = Record((), every=every, samples=(0, len(taken) - 1))
    assert clock.samples(chosen).tolist() == [taken[0], taken[-1]]
    assert clock.last(chosen) == clock.last(Record((), every=every)) == taken[-1] * clock.time_step


@given(clock=clocks, every=intervals, k=st.integers(1, 1000), initial=st.booleans())
def test_substeps_do_not_move_samples(clock: Clock, every: float, k: int, initial: bool) -> None:
    finer = Clock(clock.time_step / k, clock.total * k, k)
    record = Record((), every=every, initial=initial)
    assert finer.samples(record).tolist() == (k * clock.samples(record)).tolist()
    assert finer.count(every) == clock.count(every)


def test_the_paper_samples_six_times() -> None:
    assert Clock(3.2029e-3, 22).samples(Record((), every=0.01)).tolist() == [1, 5, 9, 13, 17, 21]


def test_without_an_interval_every_step_is_sampled() -> None:
    assert Clock(0.1, 5).samples(Record(())).tolist() == [1, 2, 3, 4, 5]


def test_an_endless_interval_has_one_sample() -> None:
    assert Clock(1e-300, 5).samples(Record((), every=1e300)).tolist() == [1]


def test_samples_are_chosen_by_index() -> None:
    record = Record((), every=0.25, samples=(0, 2), initial=True)
    assert Clock(0.1, 9).samples(record).tolist() == [0, 1, 7]


class TestCheck:
    clocks = (Clock(0.1, 10), Clock(0.2, 5))

    def test_the_clock_with_the_fewest_samples_decides(self) -> None:
        check_samples(Record((), samples=(4,)), self.clocks, 1.0)
        with pytest.raises(ConfigurationError, match=r"sample 5 .* 1\.0 s .* 5 steps, .* 0 to 4;"):
            check_samples(Record((), samples=(5,)), self.clocks, 1.0)

    @pytest.mark.parametrize(
        ("samples", "until", "last"),
        [((0, 2), 0.3, "0.3"), ((0, 2), 0.31, "0.3"), (None, 1.0, "1"), (None, 1.01, "1"), ((), 0.1, "0")],
    )
    def test_the_last_sample_must_reach_the_required_time(
        self, samples: tuple[int, ...] | None, until: float, last: str
    ) -> None:
        record = Record((), samples=samples, until=until)
        if until <= float(last) * (1 + 1e-12):
            check_samples(record, self.clocks, 1.0)
            return
        with pytest.raises(ConfigurationError, match=rf" {last} s, .* {until} s; .* 1\.0 s"):
            check_samples(record, self.clocks, 1.0)
