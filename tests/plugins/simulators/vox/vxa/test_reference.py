"""Reference cases of the engine, exported to VXA files, read again and simulated."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from evoframe import Design, Record
from evoframe.documents.structuring import structure
from evoframe_simulators import FixedRegion, PaletteMaterial, Vox
from evoframe_simulators.vox.regions import fixed_mask

ENVIRONMENT = Path(__file__).parents[4] / "data" / "environment"
CASES = sorted(path.stem for path in ENVIRONMENT.glob("*.npz"))
BASE = 25.0


def simulator(case: dict[str, Any], *, clamped: bool) -> Vox:
    """Return the simulator for a reference case, whose settings use the names of the solver."""
    options = dict(case["settings"])
    palette = tuple(
        PaletteMaterial(code=int(code), expansion_coefficient=material.pop("expansion"), **material)
        for code, material in case["palette"].items()
    )
    return Vox(
        palette=palette,
        fixed=(FixedRegion(),) if clamped else (),
        temperature_base=BASE,
        temperature_amplitude=BASE + options.pop("temperature_amplitude"),
        frequency=1 / options.pop("period"),
        collision_damping=options.pop("floor_damping"),
        **options,
    )


def largest(a: NDArray[np.float64], b: NDArray[np.float64]) -> float:
    return float(np.nanmax(np.abs(a - b)))


def test_all_cases_exist() -> None:
    assert [name[:2] for name in CASES] == [f"{n:02}" for n in range(1, 19)]


@pytest.mark.parametrize("name", CASES)
def test_motion_agrees_with_the_engine(name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with np.load(ENVIRONMENT / f"{name}.npz") as file:
        golden = dict(file)
    case = json.loads(str(golden["case"]))
    vox = simulator(case, clamped=bool(golden["fixed"].any()))
    assert (fixed_mask(vox.fixed, golden["material"].shape) == golden["fixed"]).all()

    export = vox.export(
        Design({"morphology": golden["material"], "controller": golden["phase_cycles"]}), "vxa"
    )
    assert export.left_out == ()
    path = tmp_path / f"{name}.vxa"
    path.write_bytes(export.data)
    again = structure(Vox.settings_of(path), Vox, ("simulator",))
    [(_, design)] = again.read(path)

    assert golden["step"][0] == 0
    later = tuple((golden["step"][1:] - 1).tolist())
    [outcome] = again.simulate([design], Record(("face", "body", "voxels"), samples=later, initial=True))
    assert (outcome.steps == golden["step"]).all()
    assert outcome.diverged_at is None
    off = {
        "face": largest(outcome.tracks["face"], golden["face"]),
        "body": largest(outcome.tracks["body"], golden["body"]),
        "final": largest(outcome.tracks["voxels"][-1], golden["final_position"]),
    }
    limit = max(1e-7, 10.0 * case["nudge_max_dev_m"])
    deviations = "  ".join(f"{track} {value:7.1e}" for track, value in off.items())
    with capsys.disabled():
        print(f"\nvxa {name:25} {deviations} m (limit {limit:.1e})", end=" ")  # noqa: T201
    assert max(off.values()) < limit
