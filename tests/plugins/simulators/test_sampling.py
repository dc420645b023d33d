"""Which steps are sampled: the rule of the paper's engine, in closed form."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from evoframe import Record
from evoframe_simulators.sampling import count_samples, sample_steps

time_steps = st.floats(1e-5, 1e-2)
step_counts = st.integers(1, 200)
intervals = st.floats(0, 0.1)


@given(time_step=time_steps, steps=step_counts, every=intervals, initial=st.booleans())
def test_samples_are_ascending_and_at_least_so_far_apart(
    time_step: float, steps: int, every: float, initial: bool
) -> None:
    taken = sample_steps(time_step, steps, Record((), every=every, initial=initial))
    assert taken[0] == (0 if initial else 1)
    taken = taken[1:] if initial else taken
    assert taken[0] == 1
    assert (np.diff(taken) >= 1).all()
    assert (np.diff(taken) * time_step >= every * (1 - 1e-12) - 1e-12).all()
    assert taken[-1] <= steps


@given(time_step=time_steps, steps=step_counts, every=intervals)
def test_no_step_that_is_due_is_missed(time_step: float, steps: int, every: float) -> None:
    taken = sample_steps(time_step, steps, Record((), every=every))
    gaps = np.diff([*taken, steps + 1])
    assert ((gaps == 1) | ((gaps - 1) * time_step < every)).all()


@given(time_step=time_steps, multiple=st.integers(1, 10**6))
def test_an_interval_that_is_a_multiple_of_the_time_step_is_met(time_step: float, multiple: int) -> None:
    for every in (multiple * time_step, np.nextafter(multiple * time_step, np.inf)):
        assert sample_steps(time_step, multiple + 1, Record((), every=every)).tolist() == [1, 1 + multiple]


@given(time_step=time_steps, steps=step_counts, every=intervals)
def test_as_many_samples_are_taken_as_are_counted(time_step: float, steps: int, every: float) -> None:
    taken = sample_steps(time_step, steps, Record((), every=every))
    assert count_samples(time_step, steps, every) == len(taken)
    chosen = Record((), every=every, samples=(0, len(taken) - 1))
    assert sample_steps(time_step, steps, chosen).tolist() == [taken[0], taken[-1]]


def test_the_paper_samples_six_times() -> None:
    assert sample_steps(3.2029e-3, 22, Record((), every=0.01)).tolist() == [1, 5, 9, 13, 17, 21]


def test_without_an_interval_every_step_is_sampled() -> None:
    assert sample_steps(0.1, 5, Record(())).tolist() == [1, 2, 3, 4, 5]


def test_an_interval_without_end_gives_one_sample() -> None:
    assert sample_steps(1e-300, 5, Record((), every=1e300)).tolist() == [1]


def test_samples_are_chosen_by_index() -> None:
    record = Record((), every=0.25, samples=(0, 2), initial=True)
    assert sample_steps(0.1, 9, record).tolist() == [0, 1, 7]
