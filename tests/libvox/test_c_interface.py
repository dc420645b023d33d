"""Parts of the C interface that Python does not use: missing arrays, sizes, statuses, and a C program."""

import re
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest
from symbols import ROOT, sources_of

import evoframe_libvox
from evoframe_libvox._vox import ffi, lib

FIELDS = {
    "nx": 2,
    "ny": 1,
    "nz": 1,
    "voxel_size": 0.05,
    "time_step_fraction": 0.9,
    "substeps": 1,
    "duration": 0.07,
    "step_limit": 1000,
    "temperature_amplitude": 14.0,
    "period": 0.25,
    "start_time": 0.0,
    "ramp": 0.0,
    "smallest_size": 0.1,
    "largest_size": 3.0,
    "size_clamp": 0,
    "gravity": 0.0,
    "floor": 0,
    "floor_slope": 0.0,
    "falling_code": 0,
    "fluid_drag": 0.0,
    "fluid_by_size": 0,
    "bond_damping": 1.0,
    "slow_damping": 0.01,
    "floor_damping": 0.8,
    "contact_damping": 0.0,
    "self_collision": 1,
    "contact_friction": 0,
    "complete_contacts": 0,
    "collision_envelope": 1.5,
    "collision_horizon": 2.0,
    "collision_list_factor": 1.5,
    "kernel": 0,
    "whole_body": 0,
    "largest_strain": 100.0,
    "largest_distance": 100.0,
}
SUBSTANCE = {
    "used": 1,
    "youngs_modulus": 5e6,
    "poisson_ratio": 0.35,
    "density": 1e6,
    "expansion": 0.0,
    "static_friction": 1.0,
    "dynamic_friction": 0.5,
}


def settings(**changes: Any) -> Any:
    return ffi.new("struct vox_settings *", FIELDS | changes)


def palette(**changes: Any) -> Any:
    return ffi.new("struct vox_material[2]", [{}, SUBSTANCE | changes])


def created(status: int, **changes: Any) -> Any:
    """Create a model and check the status; return the culprit."""
    made, culprit = ffi.new("vox_model **"), ffi.new("int64_t *", 77)
    fields, substance = ({k: v for k, v in changes.items() if k in one} for one in (FIELDS, SUBSTANCE))
    fixed = ffi.new("uint8_t[]", changes.get("fixed", [0, 0]))
    found = lib.vox_model_create(settings(**fields), palette(**substance), 2, fixed, made, culprit)
    assert found == status
    assert (made[0] == ffi.NULL) == (status != lib.VOX_OK)
    lib.vox_model_destroy(made[0])
    return culprit[0]


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


def test_every_field_is_given_here() -> None:
    """The tests below require a complete model."""
    for struct, fields in (("vox_settings", FIELDS), ("vox_material", SUBSTANCE)):
        assert [name for name, _ in ffi.typeof(f"struct {struct}").fields] == list(fields)


def test_every_setting_and_property_has_a_status_of_its_name() -> None:
    """Every invalid number except switches has a status with its name, and those of materials the code."""
    statuses = {name: code for code, name in ffi.typeof("enum vox_status").elements.items()}
    switches = {"nx", "ny", "nz", "floor", "self_collision", "contact_friction", "complete_contacts"}
    switches |= {"size_clamp", "fluid_by_size"}
    for fields, culprit in ((FIELDS, -1), (SUBSTANCE, 1)):
        for name in fields.keys() - switches - {"whole_body", "used"}:
            bad = float("nan") if isinstance(fields[name], float) else -1
            assert created(statuses[f"VOX_BAD_{name.upper()}"], **{name: bad}) == culprit


def in_header(words: str) -> str:
    """Return a range in the notation of comments in the header."""
    for pattern, notation in (
        (r"between (\S+) and (\S+).*", r"\1 .. \2"),
        (r"above (\S+) and at most (\S+).*", r"\1 < . <= \2"),
        (r"at least (\S+)", r">= \1"),
        (r"finite and not negative", ">= 0"),
        (r"finite", ""),
    ):
        if re.fullmatch(pattern, words):
            return re.sub(pattern, notation, words)
    raise AssertionError(words)


def test_the_header_states_the_ranges() -> None:
    """The comments agree with the table of ranges."""
    header = (ROOT / "libvox" / "include" / "vox.h").read_text(encoding="utf-8")
    ranges = {**evoframe_libvox.SETTING_RANGES, **evoframe_libvox.PROPERTY_RANGES}
    for name, span in ranges.items():
        [comment] = re.findall(rf"(?:double|int64_t) {name}; +/\*(.*?)\*/", header, re.DOTALL)
        assert in_header(span.words) in comment


def test_ranges_end_after_the_last() -> None:
    for nth, count in ((lib.vox_setting_range, 24), (lib.vox_property_range, 6)):
        assert nth(count - 1) != ffi.NULL
        assert nth(count) == nth(-1) == nth(-(2**31)) == nth(2**31 - 1) == ffi.NULL


def test_the_culprit_is_the_first_invalid_fixed_cell() -> None:
    assert created(lib.VOX_OK, fixed=[0, 63]) == -1
    assert created(lib.VOX_BAD_FIXED, fixed=[0, 64]) == 1
    assert created(lib.VOX_BAD_FIXED, fixed=[255, 64]) == 0


def test_degrees_of_freedom_are_bits() -> None:
    bits = [lib.VOX_FIX_X, lib.VOX_FIX_Y, lib.VOX_FIX_Z]
    bits += [lib.VOX_FIX_ROTATION_X, lib.VOX_FIX_ROTATION_Y, lib.VOX_FIX_ROTATION_Z]
    assert bits == [1 << n for n in range(6)]
    assert sum(bits) == lib.VOX_FIX_ALL == evoframe_libvox.FIX_ALL


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
    arguments = [model, 1, material, phase, 1, steps, tracks, diverged, ffi.NULL, ffi.NULL]
    assert lib.vox_simulate(*arguments) == lib.VOX_OK
    for i in (0, 2, 3, 5, 6, 7):
        assert lib.vox_simulate(*arguments[:i], ffi.NULL, *arguments[i + 1 :]) == lib.VOX_NULL_ARGUMENT
    assert lib.vox_time_steps(model, 1, ffi.NULL, ffi.NULL, ffi.NULL, ffi.NULL) == lib.VOX_NULL_ARGUMENT
    assert lib.vox_time_steps(model, 1, material, ffi.NULL, ffi.NULL, ffi.NULL) == lib.VOX_OK


def test_the_culprit_is_the_body(model: Any) -> None:
    """Also for invalid sample steps and too many steps."""
    material, phase = ffi.new("uint8_t[4]", [1, 1, 1, 1]), ffi.new("double[4]")
    tracks, diverged, culprit = ffi.new("struct vox_tracks *"), ffi.new("int64_t[2]"), ffi.new("int64_t *")
    for steps, status, body in (
        ([0, 1, 0, 1], lib.VOX_OK, -1),
        ([0, 1, 1, 1], lib.VOX_BAD_SAMPLE_ORDER, 1),
        ([0, 0, 1, 1], lib.VOX_BAD_SAMPLE_ORDER, 0),
        ([0, 1, 2, 23], lib.VOX_SAMPLE_OUT_OF_RANGE, 1),
    ):
        rows = ffi.new("int64_t[4]", steps)
        arguments = [model, 2, material, phase, 2, rows, tracks, diverged, ffi.NULL, culprit]
        assert lib.vox_simulate(*arguments) == status
        assert culprit[0] == body
    limited = ffi.new("vox_model **")
    assert (
        lib.vox_model_create(settings(step_limit=21), palette(), 2, ffi.NULL, limited, ffi.NULL) == lib.VOX_OK
    )
    assert lib.vox_time_steps(limited[0], 2, material, ffi.NULL, ffi.NULL, culprit) == lib.VOX_TOO_MANY_STEPS
    assert culprit[0] == 0
    lib.vox_model_destroy(limited[0])


def test_a_call_that_fails_does_not_change_the_buffers(model: Any) -> None:
    """Also those of bodies before the invalid one."""
    material, phase = ffi.new("uint8_t[4]", [1, 1, 1, 2]), ffi.new("double[4]")
    tip, diverged = ffi.new("double[6]", [7.0] * 6), ffi.new("int64_t[2]", [7, 7])
    repeated = ffi.new("uint8_t[2]", [7, 7])
    tracks, steps = ffi.new("struct vox_tracks *", {"tip": tip}), ffi.new("int64_t[2]", [1, 1])
    status = lib.vox_simulate(model, 2, material, phase, 1, steps, tracks, diverged, repeated, ffi.NULL)
    assert status == lib.VOX_UNKNOWN_MATERIAL
    assert list(tip) == [7.0] * 6
    assert list(diverged) == [7, 7]
    assert list(repeated) == [7, 7]


def test_steps_may_be_missing_without_samples(model: Any) -> None:
    material, phase = ffi.new("uint8_t[2]", [1, 1]), ffi.new("double[2]")
    tracks, diverged = ffi.new("struct vox_tracks *"), ffi.new("int64_t[1]", [5])
    repeated = ffi.new("uint8_t *", 5)
    status = lib.vox_simulate(model, 1, material, phase, 0, ffi.NULL, tracks, diverged, repeated, ffi.NULL)
    assert status == lib.VOX_OK
    assert diverged[0] == repeated[0] == 0


@pytest.mark.parametrize(("bodies", "samples"), [(-1, 1), (1, -1), (2**62, 1), (2**31, 2**31), (1, 2**62)])
def test_batch_sizes_do_not_overflow(model: Any, bodies: int, samples: int) -> None:
    material, phase = ffi.new("uint8_t[2]", [1, 1]), ffi.new("double[2]")
    steps, tracks, diverged = ffi.new("int64_t[1]"), ffi.new("struct vox_tracks *"), ffi.new("int64_t[1]")
    status = lib.vox_simulate(
        model, bodies, material, phase, samples, steps, tracks, diverged, ffi.NULL, ffi.new("int64_t *")
    )
    assert status == lib.VOX_BAD_BATCH


def test_the_version_agrees_with_the_header() -> None:
    header = (ROOT / "libvox" / "include" / "vox.h").read_text(encoding="utf-8")
    [version] = re.findall(r'^#define VOX_VERSION "(\d+\.\d+\.\d+)"$', header, re.MULTILINE)
    assert version == evoframe_libvox.VERSION


def test_a_c_program_runs(tmp_path: Path) -> None:
    compiler = shutil.which("cc")
    assert compiler, "this test requires the C compiler cc, like the installation"
    sources = map(str, sources_of("libvox"))
    program = str(tmp_path / "embed")
    include = ["-I", str(ROOT / "libvox" / "include"), "-I", str(ROOT / "libvox")]
    embed = str(ROOT / "tests" / "libvox" / "embed.c")
    subprocess.run([compiler, "-std=c11", "-O1", *include, embed, *sources, "-o", program, "-lm"], check=True)
    output = subprocess.run([program], check=True, capture_output=True, text=True).stdout
    assert output.splitlines()[0].startswith("tip after 44 steps: ")
    assert output.splitlines()[1].startswith("energy: ")
