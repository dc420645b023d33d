"""The paper's setting, compared with traces of the authors' engine."""

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from evoframe_libvox import KERNELS, Model, Result, Track

Arrays = dict[str, NDArray[np.float64]]
ModelMaker = Callable[..., Model]


@pytest.fixture(scope="module", params=KERNELS)
def kernel(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture(scope="module")
def result(paper: Arrays, paper_model: ModelMaker, kernel: str) -> Result:
    return paper_model(kernel=kernel).simulate(paper["material"], paper["phase_cycles"], range(23))


def largest(a: NDArray[np.float64], b: NDArray[np.float64]) -> float:
    return float(np.nanmax(np.abs(a - b)))


def test_time_step_and_steps_agree_with_the_engine(paper: Arrays, paper_model: ModelMaker) -> None:
    dt, steps = paper_model().time_steps(paper["material"])
    assert np.allclose(dt, paper["time"][1], rtol=1e-14, atol=0.0)
    assert (steps == 22).all()


@pytest.mark.parametrize("whole_body", [False, True])
def test_skipping_the_last_step_changes_no_bit(
    paper: Arrays, paper_model: ModelMaker, result: Result, kernel: str, whole_body: bool
) -> None:
    model = paper_model(kernel=kernel, whole_body=whole_body)
    brief = model.simulate(paper["material"], paper["phase_cycles"], [1, 21], ["tip"])
    assert np.array_equal(brief.tracks["tip"], result.tracks["tip"][:, [1, 21]])
    assert not brief.diverged_step.any()


def test_nothing_diverges(result: Result) -> None:
    assert not result.diverged_step.any()


def test_displacements_agree_with_the_engine(
    paper: Arrays, result: Result, report: Callable[[str], None]
) -> None:
    z = result.tracks["tip"][..., 2]
    off = largest(z[:, 21] - z[:, 1], paper["displacement"])
    report(f"36 displacements: largest deviation {off:.2e} m (limit 1e-9)")
    assert off < 1e-9


@pytest.mark.parametrize(("track", "golden"), [("tip", "tip"), ("face", "free_face_mean")])
def test_traces_agree_with_the_engine(
    paper: Arrays, result: Result, track: Track, golden: str, report: Callable[[str], None]
) -> None:
    off = largest(result.tracks[track], paper[golden])
    report(f"{track} after each of 22 steps: largest deviation {off:.2e} m (limit 1e-9)")
    assert off < 1e-9


def test_final_positions_agree_with_the_engine(
    paper: Arrays, result: Result, report: Callable[[str], None]
) -> None:
    final = result.tracks["voxels"][:, -1]
    off = largest(final, paper["final_position"])
    report(f"every voxel after the last step: largest deviation {off:.2e} m (limit 1e-8)")
    assert off < 1e-8
    assert (np.isnan(final).all(axis=-1) == (paper["material"] == 0)).all()


def test_the_published_bodies_move_without_actuation(paper: Arrays, paper_model: ModelMaker) -> None:
    published = [0, 3, 6]  # AFPO, HyperNEAT, NEAT with zero offsets
    model = paper_model(expansion=0.0)
    z = model.simulate(paper["material"][published], paper["phase_cycles"][published], [1, 21], ["tip"])
    tip = z.tracks["tip"][..., 2]
    assert tip[:, 1] - tip[:, 0] == pytest.approx([0.0011106, 0.0019527, 0.0020189], abs=5e-8)


def test_self_collision_causes_this_motion(paper: Arrays, paper_model: ModelMaker) -> None:
    published = [0, 3, 6]
    model = paper_model(expansion=0.0, self_collision=False)
    voxels = model.simulate(paper["material"][published], paper["phase_cycles"][published], [1, 21], ["tip"])
    tip = voxels.tracks["tip"][..., 2]
    assert np.abs(tip[:, 1] - tip[:, 0]).max() < 1e-8
