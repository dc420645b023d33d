"""Longer motions, compared with traces of the original engine (see tests/data/environment/README.md)."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from evoframe_libvox import KERNELS, Material, Model, Settings

ENVIRONMENT = Path(__file__).parent.parent / "data" / "environment"
CASES = sorted(path.stem for path in ENVIRONMENT.glob("*.npz"))

# The requirement is 1e-7 m, or ten times the sensitivity of a case; the solver stays within these limits.
LIMIT = 1e-9
LIMITS = {"06_active_bar_inphase": 1e-8}  # effect of other arithmetic (docs/physics.md, 16)


def largest(a: NDArray[np.float64], b: NDArray[np.float64]) -> float:
    return float(np.nanmax(np.abs(a - b)))


def test_all_cases_exist() -> None:
    assert [name[:2] for name in CASES] == [f"{n:02}" for n in range(1, 19)]


def load(name: str, **how: Any) -> tuple[dict[str, NDArray[Any]], dict[str, Any], Model]:
    """Return the arrays of a case, its description and its model."""
    with np.load(ENVIRONMENT / f"{name}.npz") as file:
        golden = dict(file)
    case = json.loads(str(golden["case"]))
    palette = {int(code): Material(**fields) for code, fields in case["palette"].items()}
    x, y, z = golden["material"].shape
    return golden, case, Model((x, y, z), palette, Settings(**case["settings"]), golden["fixed"], **how)


@pytest.mark.parametrize("kernel", KERNELS)
@pytest.mark.parametrize("name", CASES)
def test_motion_agrees_with_the_engine(name: str, kernel: str, report: Callable[[str], None]) -> None:
    golden, case, model = load(name, kernel=kernel)
    body = golden["material"]
    dt, steps = model.time_steps(body[None])
    assert dt[0] == pytest.approx(case["dt"], rel=1e-14)
    assert steps[0] == case["steps"] == golden["step"][-1]

    result = model.simulate(
        body[None], golden["phase_cycles"][None], golden["step"], ["face", "body", "voxels"]
    )
    off = {
        "face": largest(result.tracks["face"][0], golden["face"]),
        "body": largest(result.tracks["body"][0], golden["body"]),
        "final": largest(result.tracks["voxels"][0, -1], golden["final_position"]),
    }
    asked, limit = max(1e-7, 10.0 * case["nudge_max_dev_m"]), LIMITS.get(name, LIMIT)
    deviations = "  ".join(f"{track} {value:7.1e}" for track, value in off.items())
    report(f"{name:25} {kernel:8} {deviations} m (limit {limit:.0e}, asked {asked:.1e})")
    assert max(off.values()) < limit < asked
    assert not result.diverged_step.any()


def test_a_mirrored_bimorph_deviates_like_in_the_engine() -> None:
    """A bond has the frame of its lower voxel: 3.9e-5 m, and 7e-6 m sideways (docs/physics.md, 12.3)."""
    golden, _, model = load("07_bimorph_20x8x8")
    body = golden["material"]
    batch = np.stack([body, body[:, :, ::-1]])
    plain, mirrored = model.simulate(batch, np.zeros(batch.shape), golden["step"], ["face"]).tracks["face"]
    height = body.shape[2] * model.settings.voxel_size
    assert np.abs(plain[:, 2] - (height - mirrored[:, 2])).max() == pytest.approx(3.9e-5, rel=0.01)
    assert np.abs(plain[:, 1] - plain[0, 1]).max() == pytest.approx(7e-6, rel=0.05)
