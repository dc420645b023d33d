"""The C interface, where Python does not pass: missing arrays, sizes, statuses, and a program in C."""

import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest

from evoframe_libvox._vox import ffi, lib

ROOT = Path(__file__).parent.parent.parent


def settings(**changes: Any) -> Any:
    fields = {
        "nx": 2,
        "ny": 1,
        "nz": 1,
        "voxel_size": 0.05,
        "time_step_fraction": 0.9,
        "duration": 0.07,
        "temperature_amplitude": 14.0,
        "period": 0.25,
        "bond_damping": 1.0,
        "slow_damping": 0.01,
        "self_collision": 1,
        "collision_horizon": 2.0,
        "collision_list_factor": 1.5,
    }
    return ffi.new("struct vox_settings *", fields | changes)


def palette() -> Any:
    return ffi.new("struct vox_material[2]", [{}, {"used": 1, "youngs_modulus": 5e6, "density": 1e6}])


@pytest.fixture
def model() -> Any:
    made = ffi.new("vox_model **")
    assert lib.vox_model_create(settings(), palette(), 2, ffi.NULL, made, ffi.NULL) == lib.VOX_OK
    return ffi.gc(made[0], lib.vox_model_destroy)


def test_every_status_has_a_message() -> None:
    statuses = ffi.typeof("enum vox_status").elements
    messages = [ffi.string(lib.vox_status_message(status)).decode() for status in statuses]
    assert len(set(messages)) == len(statuses)
    assert "unknown status" not in messages
    assert ffi.string(lib.vox_status_message(12345)) == b"unknown status"


def test_missing_arguments_of_a_model() -> None:
    made = ffi.new("vox_model **")
    null = ffi.NULL
    assert lib.vox_model_create(null, palette(), 2, null, made, null) == lib.VOX_NULL_ARGUMENT
    assert lib.vox_model_create(settings(), null, 2, null, made, null) == lib.VOX_NULL_ARGUMENT
    assert lib.vox_model_create(settings(), palette(), 2, null, null, null) == lib.VOX_NULL_ARGUMENT
    assert made[0] == null
    lib.vox_model_destroy(null)


@pytest.mark.parametrize("n_codes", [-1, 0, 1, 257, 2**31 - 1])
def test_number_of_codes(n_codes: int) -> None:
    made = ffi.new("vox_model **")
    status = lib.vox_model_create(settings(), palette(), n_codes, ffi.NULL, made, ffi.NULL)
    assert status == lib.VOX_BAD_PALETTE
    assert made[0] == ffi.NULL


@pytest.mark.parametrize(
    "edges", [(2**62, 2**62, 2**62), (2**24 + 1, 1, 1), (1, 2**24 + 1, 1), (2**12, 2**12, 2), (-1, -1, 1)]
)
def test_canvas_sizes_do_not_overflow(edges: tuple[int, int, int]) -> None:
    made = ffi.new("vox_model **")
    nx, ny, nz = edges
    status = lib.vox_model_create(settings(nx=nx, ny=ny, nz=nz), palette(), 2, ffi.NULL, made, ffi.NULL)
    assert status == lib.VOX_BAD_CANVAS


def test_missing_arguments_of_a_batch(model: Any) -> None:
    material, phase = ffi.new("uint8_t[2]", [1, 1]), ffi.new("double[2]")
    steps, tracks, diverged = ffi.new("int64_t[1]"), ffi.new("struct vox_tracks *"), ffi.new("int64_t[1]")
    arguments = [model, 1, material, phase, 1, steps, tracks, diverged, ffi.NULL]
    assert lib.vox_simulate(*arguments) == lib.VOX_OK
    for i in (0, 2, 3, 5, 6, 7):
        assert lib.vox_simulate(*arguments[:i], ffi.NULL, *arguments[i + 1 :]) == lib.VOX_NULL_ARGUMENT
    assert lib.vox_time_steps(model, 1, ffi.NULL, ffi.NULL, ffi.NULL, ffi.NULL) == lib.VOX_NULL_ARGUMENT
    assert lib.vox_time_steps(model, 1, material, ffi.NULL, ffi.NULL, ffi.NULL) == lib.VOX_OK


@pytest.mark.parametrize(("bodies", "samples"), [(-1, 1), (1, -1), (2**62, 1), (2**31, 2**31), (1, 2**62)])
def test_batch_sizes_do_not_overflow(model: Any, bodies: int, samples: int) -> None:
    material, phase = ffi.new("uint8_t[2]", [1, 1]), ffi.new("double[2]")
    steps, tracks, diverged = ffi.new("int64_t[1]"), ffi.new("struct vox_tracks *"), ffi.new("int64_t[1]")
    status = lib.vox_simulate(
        model, bodies, material, phase, samples, steps, tracks, diverged, ffi.new("int64_t *")
    )
    assert status == lib.VOX_BAD_BATCH


def test_a_program_in_c_runs(tmp_path: Path) -> None:
    compiler = shutil.which("cc")
    assert compiler, "this test needs the C compiler cc, as the installation did"
    sources = [str(path) for path in sorted((ROOT / "libvox").glob("*.c"))]
    program = str(tmp_path / "embed")
    include = ["-I", str(ROOT / "libvox" / "include")]
    embed = str(ROOT / "tests" / "libvox" / "embed.c")
    subprocess.run([compiler, "-std=c11", "-O1", *include, embed, *sources, "-o", program, "-lm"], check=True)
    said = subprocess.run([program], check=True, capture_output=True, text=True).stdout
    assert said.startswith("tip after 22 steps: ")
