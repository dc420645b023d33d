"""Longer motions, against traces of the original engine (see tests/data/environment/README.md)."""

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from evoframe_libvox import Material, Model, Settings

CASES = [
    "02_two_voxel_axial",
    "06_active_bar_inphase",
    "08_wave_20x8x8",
    "09_quadrants_20x8x8",
    "12_mixed_stiffness",
    "15_selfcollision_tweezer",
    "16_bimorph_rho1000",
]


@pytest.mark.parametrize("name", CASES)
def test_motion_is_the_engines(name: str, data: Path, say: Callable[[str], None]) -> None:
    with np.load(data / "environment" / f"{name}.npz") as file:
        golden = dict(file)
    case = json.loads(str(golden["case"]))
    palette = {int(code): Material(**fields) for code, fields in case["palette"].items()}
    body = golden["material"]
    model = Model(body.shape, palette, Settings(**case["settings"]), golden["clamped"])

    dt, steps = model.time_steps(body[None])
    assert dt[0] == pytest.approx(case["dt"], rel=1e-14)
    assert steps[0] == case["steps"]

    result = model.simulate(body[None], golden["phase_cycles"][None], golden["step"], ["face", "body"])
    last = model.simulate(body[None], golden["phase_cycles"][None], steps, ["voxels"])
    off = {
        "face": np.abs(result.tracks["face"][0] - golden["face"]).max(),
        "body": np.abs(result.tracks["body"][0] - golden["body"]).max(),
        "final": np.nanmax(np.abs(last.tracks["voxels"][0, 0] - golden["final_position"])),
    }
    limit = max(1e-9, 10.0 * case["nudge_max_dev_m"])
    say(
        f"{name}: "
        + ", ".join(f"{track} {value:.1e}" for track, value in off.items())
        + f" m (limit {limit:.1e})"
    )
    assert max(off.values()) < limit
    assert not result.diverged_step.any()
