"""Convert traces written by a build of the original engine to the files of this folder.

    python tests/data/environment/convert.py FOLDER

FOLDER has one folder for each case, with ``case.json`` (what was simulated, engine-neutral), ``trace.csv``
(the mean of the voxels with the largest initial x, and that of the whole body) and ``final_positions.csv``.
Every sampled row and every voxel is kept, in double precision; README.md describes the files.
"""

import csv
import json
import sys
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

HERE = Path(__file__).parent
FIX_ALL = 63  # all six degrees of freedom


def settings(case: dict[str, Any]) -> dict[str, Any]:
    """Return the settings of a case under the solver's names."""
    gravity, actuation, damping = case["gravity"], case["actuation"], case["damping"]
    return {
        "voxel_size": case["lattice_dim"],
        "duration": case["duration"],
        "time_step_fraction": case["dt_frac"],
        "temperature_amplitude": actuation["dT"],
        "period": actuation["period"],
        "start_time": actuation["start_time"],
        "gravity": gravity["g"] if gravity["enabled"] else 0.0,
        "floor": case["floor"]["enabled"],
        "bond_damping": damping["bond"],
        "slow_damping": damping["slow"],
        "floor_damping": damping["collision"],
        "self_collision": case["self_collision"],
        "collision_horizon": case["collision_horizon"],
    }


def substance(material: dict[str, Any]) -> dict[str, float]:
    return {
        "youngs_modulus": material["E"],
        "poisson_ratio": material["nu"],
        "density": material["rho"],
        "expansion": material["cte"],
        "static_friction": material["mu_static"],
        "dynamic_friction": material["mu_dynamic"],
    }


def described(case: dict[str, Any]) -> dict[str, Any]:
    """Return all data of a case except arrays: its description and settings, and the engine's own figures."""
    return {
        "description": case["description"],
        "settings": settings(case),
        "palette": {str(material["id"]): substance(material) for material in case["materials"]},
        "dt": case["engine"]["dt"],
        "steps": case["engine"]["steps"],
        "nudge_max_dev_m": case["sensitivity"]["nudge_1e-6N"]["max_m"],
    }


def over_cells(flat: list[float] | None, canvas: tuple[int, int, int]) -> NDArray[np.float64]:
    """Return a flat list with x fastest as an array ``[X, Y, Z]``; zeros for ``None``."""
    if flat is None:
        return np.zeros(canvas)
    return np.array(flat, np.float64).reshape(canvas[::-1]).transpose(2, 1, 0)


def fixed(case: dict[str, Any], canvas: tuple[int, int, int]) -> NDArray[np.uint8]:
    mask = np.zeros(canvas, np.uint8)
    mask[case["fixed_slab_x"]] = FIX_ALL
    return mask


def columns(path: Path, *names: str) -> NDArray[np.float64]:
    with path.open(encoding="ascii", newline="") as file:
        return np.array([[float(row[name]) for name in names] for row in csv.DictReader(file)])


def final_positions(path: Path, canvas: tuple[int, int, int]) -> NDArray[np.float64]:
    positions = np.full((*canvas, 3), np.nan)
    for row in columns(path, "ix", "iy", "iz", "x", "y", "z"):
        positions[tuple(row[:3].astype(int))] = row[3:]
    return positions


def pack(folder: Path, target: Path) -> None:
    case = json.loads((folder / "case.json").read_text(encoding="utf-8"))
    x, y, z = case["dims"]
    trace = folder / "trace.csv"
    np.savez_compressed(
        target,
        case=np.array(json.dumps(described(case))),
        material=over_cells(case["material"], (x, y, z)).astype(np.uint8),
        phase_cycles=over_cells(case["phase"], (x, y, z)),
        fixed=fixed(case, (x, y, z)),
        step=columns(trace, "step")[:, 0].astype(np.int64),
        face=columns(trace, "x", "y", "z"),
        body=columns(trace, "body_x", "body_y", "body_z"),
        final_position=final_positions(folder / "final_positions.csv", (x, y, z)),
    )


def main() -> None:
    for path in sorted(Path(sys.argv[1]).glob("*/case.json")):
        pack(path.parent, HERE / f"{path.parent.name}.npz")


if __name__ == "__main__":
    main()
