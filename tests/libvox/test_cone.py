"""Only what can reach a sample is computed: recorded points have the bits of the whole body.

A body is compared with ``whole_body=True``. Contacts of what is computed may depend on what is not; bodies on
which this happens are simulated again as a whole, and say so with ``Result.repeated``.
"""

from collections.abc import Callable
from typing import Any

import attrs
import numpy as np
import pytest
from hypothesis import given, strategies as st
from numpy.typing import NDArray
from soft_bodies import (
    CONTACTS,
    SURROUNDINGS,
    Bytes,
    Case,
    Floats,
    assert_same_as_whole,
    cases,
)

from evoframe_libvox import FIX_ALL, KERNELS, Material, Model, Result, Track

ModelMaker = Callable[..., Model]
Arrays = dict[str, NDArray[Any]]

RECORDS: tuple[tuple[Track, ...], ...] = (("tip",), ("face",), ("tip", "face"))
LONG = (14, 4, 4)  # with few steps, most of such a body is left out


# ---- random bodies


def sampled(case: Case, numbers: list[int]) -> list[int]:
    """Return ascending steps of a body, given any numbers."""
    return sorted({min(number, case.steps()) for number in numbers})


def assert_nothing_is_missing(
    case: Case, numbers: list[int], record: tuple[Track, ...], kernel: str | None = None
) -> Result:
    samples = sampled(case, numbers)
    usual = case.simulate(samples, record, kernel=kernel)
    whole = case.simulate(samples, record, kernel=kernel, whole_body=True)
    assert_same_as_whole(usual, whole, samples)
    assert not whole.repeated.any()
    return usual


numbers = st.lists(st.integers(0, 30), min_size=1, max_size=3)
few_steps = st.lists(st.integers(1, 9), min_size=1, max_size=3)  # less than the length of the body


@pytest.mark.parametrize("kernel", KERNELS)
@given(case=cases(CONTACTS, LONG, (10, 1, 1)), numbers=few_steps, record=st.sampled_from(RECORDS))
def test_what_is_left_out_changes_no_bit(
    kernel: str, case: Case, numbers: list[int], record: tuple[Track, ...]
) -> None:
    assert_nothing_is_missing(case, numbers, record, kernel)


@given(cases(SURROUNDINGS | CONTACTS), numbers)
def test_this_holds_with_fluids_and_damped_contacts(case: Case, numbers: list[int]) -> None:
    assert_nothing_is_missing(case, numbers, ("tip",))


@given(cases(longest=LONG), numbers)
def test_recording_more_changes_nothing(case: Case, numbers: list[int]) -> None:
    """If nothing diverges: any record, and any samples before the last one."""
    samples = sampled(case, numbers)
    every = case.simulate(range(samples[-1] + 1))
    if every.diverged_step[0] > 0:
        return
    for record in RECORDS:
        few = case.simulate(samples, record)
        for track in record:
            assert np.array_equal(few.tracks[track], every.tracks[track][:, samples])


def test_few_published_bodies_are_repeated(paper: Arrays, paper_model: Callable[..., Model]) -> None:
    for tracks in RECORDS:
        result = paper_model().simulate(paper["material"], paper["phase_cycles"], [1, 21], tracks)
        assert result.repeated.mean() < 0.1


# ---- what is left out


@pytest.mark.parametrize("kernel", KERNELS)
@pytest.mark.parametrize("self_collision", [False, True])
def test_divergence_out_of_reach_is_not_divergence(
    small_model: ModelMaker, kernel: str, self_collision: bool
) -> None:
    """A bond at the far end is strained too much. It reaches the tip one voxel per step."""
    bar = np.ones((1, 20, 2, 1), np.uint8)
    bar[0, :2] = 3
    phase = np.full(bar.shape, 0.25)
    options: dict[str, Any] = {"kernel": kernel, "self_collision": self_collision, "largest_strain": 0.1}

    def diverged(last: int, **more: Any) -> int:
        model = small_model((20, 2, 1), **options, **more)
        return int(model.simulate(bar, phase, [last], ["tip"]).diverged_step[0])

    at = diverged(30, whole_body=True)
    assert 0 < at < 5
    ends = [diverged(last) for last in range(31)]
    assert ends[: at + 17] == [0] * (at + 17)
    assert ends[at + 18 :] == [at] * (31 - at - 18)


@pytest.mark.parametrize("self_collision", [False, True])
def test_nothing_is_simulated_without_a_sample(small_model: ModelMaker, self_collision: bool) -> None:
    options = {"self_collision": self_collision, "gravity": -1e200}
    bar, phase = np.ones((2, 3, 1, 1), np.uint8), np.zeros((2, 3, 1, 1))
    records: tuple[tuple[list[int], list[Track]], ...] = (([], ["tip"]), ([0], ["tip"]), ([5], []))
    for samples, tracks in records:
        result = small_model((3, 1, 1), **options).simulate(bar, phase, samples, tracks)
        assert result.diverged_step.tolist() == [0, 0]
    whole = small_model((3, 1, 1), **options, whole_body=True)
    assert (whole.simulate(bar, phase, [], []).diverged_step > 0).all()


@pytest.mark.parametrize("self_collision", [False, True])
def test_the_motion_ends_where_a_voxel_far_from_the_tip_has_fallen(
    small_model: ModelMaker, material: Callable[..., Material], self_collision: bool
) -> None:
    """Voxels of the falling material are in reach of each sample."""
    body = np.zeros((1, 20, 1, 3), np.uint8)
    body[0, :, 0, 1] = 1
    body[0, 0, 0, 0] = 2
    options: dict[str, Any] = {
        "palette": {1: material(), 2: material()},
        "gravity": -9.81,
        "falling_code": 2,
        "self_collision": self_collision,
    }
    usual, whole = (
        small_model((20, 1, 3), **options, whole_body=whole_body).simulate(
            body, np.zeros(body.shape), range(12), ["tip"]
        )
        for whole_body in (False, True)
    )
    tip = usual.tracks["tip"][0]
    assert np.array_equal(tip, whole.tracks["tip"][0])
    assert (tip[-3:] == tip[-1]).all()
    assert (tip[0] != tip[1]).any()


# ---- bodies that must be simulated as a whole


def clamped(body: Bytes) -> Bytes:
    """Return fixed cells with the slab x = 0 clamped."""
    fixed = np.zeros(body.shape, np.uint8)
    fixed[0] = FIX_ALL
    return fixed


def timed(palette: dict[int, Material], body: Bytes, phase: Floats, fixed: Bytes, **options: Any) -> Case:
    """Return a case whose period is in steps, with strains that are 10 times the expansions."""
    fields: dict[str, Any] = {"temperature_amplitude": 10.0, "duration": 1.0} | options
    dt, _ = Case(palette, body, phase, fixed, fields).model().time_steps(body[None])
    return Case(palette, body, phase, fixed, fields | {"period": fields.pop("period", 80) * float(dt[0])})


def soft(seed: int) -> Case:
    """Return a sparse body with large strains."""
    rng = np.random.default_rng(seed)
    body = np.where(rng.random((20, 4, 4)) < 0.7, 3, 0).astype(np.uint8)
    body[-1, -1, -1] = 3
    palette = {3: Material(5e6, 0.35, 1e6, 0.05)}
    return timed(palette, body, rng.uniform(-1.0, 1.0, body.shape), clamped(body), period=30)


def void() -> Case:
    """Return a bar with a void at its end, which closes."""
    body = np.full((20, 5, 5), 3, np.uint8)
    body[16:19, 1:-1, 1:-1] = 0
    palette = {3: Material(5e6, 0.35, 1e6, 0.08)}
    return timed(palette, body, np.full(body.shape, 0.25), clamped(body), period=300)


def prong(gap: int, held: int) -> Case:
    """Return a long detour from the tip to a prong, which grows towards the tip across a gap, cells.

    At the other end of the detour is a foot. The detour has the given clamped degrees of freedom; if all, the
    prong is not connected with the tip.
    """
    body = np.zeros((13 + gap, 12, 6), np.uint8)
    body[:, -1, 0] = body[0, :, :4] = body[0, -1, 4] = body[-1, -1] = 1
    body[:13, -1, 4] = 3
    fixed = np.zeros(body.shape, np.uint8)
    fixed[:, :, 0] = fixed[0] = held
    palette = {1: Material(5e6, 0.35, 1e6, 0.0), 3: Material(5e6, 0.35, 1e6, 0.06)}
    return timed(palette, body, np.zeros(body.shape), fixed, period=150)


def part() -> Case:
    """Return a beam that is clamped except for the tip, and a loose part that falls on it."""
    body, fixed = np.zeros((20, 3, 10), np.uint8), np.zeros((20, 3, 10), np.uint8)
    body[:, :, 9] = body[17:, :, 3:5] = 1
    fixed[:, :, 9] = FIX_ALL
    fixed[19, 2, 9] = 0
    palette = {1: Material(5e6, 0.35, 1e6, 0.0)}
    return timed(palette, body, np.zeros(body.shape), fixed, gravity=10.0, slow_damping=0.0)


def diagonal(seed: int) -> Case:
    """Return two bars whose voxels leave each other's reach, and come back."""
    body = np.zeros((18, 2, 2), np.uint8)
    body[:, 0, 0] = body[:, 1, 1] = body[0] = 3
    palette = {3: Material(5e6, 0.35, 1e6, 0.03)}
    phase = np.random.default_rng(seed).uniform(-1.0, 1.0, body.shape)
    contacts = {"collision_horizon": 1.42, "collision_envelope": 1.2}
    return timed(palette, body, phase, clamped(body), period=8, **contacts)


def gust() -> Case:
    """Return a bar whose far part is unstable, because its dampers are too strong for the time step."""
    body = np.full((20, 6, 6), 3, np.uint8)
    phase = np.random.default_rng(1).uniform(-1.0, 1.0, body.shape)
    palette = {3: Material(5e6, 0.35, 1e6, 0.001)}
    return timed(palette, body, phase, clamped(body), bond_damping=3.0)


REPEATED = {
    **{f"soft {seed}": (soft(seed), 14) for seed in range(4)},
    **{f"closing void, {last} steps": (void(), last) for last in (8, 14, 18)},
    **{f"near prong, held {held}": (prong(2, held), 30) for held in (0, 31, FIX_ALL)},
    **{f"far prong, held {held}": (prong(3, held), 40) for held in (0, 31, FIX_ALL)},
    "loose part": (part(), 60),
    **{f"coming back {seed}": (diagonal(seed), 14) for seed in (22, 112, 782)},
}


@pytest.mark.parametrize("kernel", KERNELS)
@pytest.mark.parametrize(("case", "last"), REPEATED.values(), ids=REPEATED.keys())
def test_a_body_with_other_contacts_is_simulated_again(case: Case, last: int, kernel: str) -> None:
    usual = case.simulate([last], ("tip",), kernel=kernel)
    whole = case.simulate([last], ("tip",), kernel=kernel, whole_body=True)
    assert usual.repeated.tolist() == [True]
    assert whole.diverged_step.tolist() == [0]
    assert_same_as_whole(usual, whole, [last])


@pytest.mark.parametrize("kernel", KERNELS)
def test_a_body_with_dampers_that_are_too_strong_is_computed_whole(kernel: str) -> None:
    """It diverges far from the tip, three steps before the sample."""
    usual = gust().simulate([20], ("tip",), kernel=kernel)
    whole = gust().simulate([20], ("tip",), kernel=kernel, whole_body=True)
    assert usual.diverged_step.tolist() == whole.diverged_step.tolist() == [17]
    assert usual.repeated.tolist() == [False]
    # with weaker dampers, a divergence there is not even computed
    weaker = attrs.evolve(gust(), options=gust().options | {"bond_damping": 1.0, "largest_strain": 0.01})
    usual = weaker.simulate([20], ("tip",), kernel=kernel)
    whole = weaker.simulate([20], ("tip",), kernel=kernel, whole_body=True)
    assert (usual.diverged_step[0], whole.diverged_step[0]) == (0, 6)


@pytest.mark.parametrize(("case", "last"), REPEATED.values(), ids=REPEATED.keys())
def test_the_contacts_of_these_bodies_affect_the_tip(case: Case, last: int) -> None:
    free = case.simulate([last], ("tip",), self_collision=False).tracks["tip"]
    assert not np.array_equal(free, case.simulate([last], ("tip",)).tracks["tip"])
