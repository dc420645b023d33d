"""Errors for invalid arguments of the solver."""

import math
import re
from collections.abc import Callable, Mapping
from typing import Any

import attrs
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings, strategies as st

import evoframe_libvox
from evoframe_libvox import PROPERTY_RANGES, SETTING_RANGES, Material, Model, Range, Settings

ModelMaker = Callable[..., Model]
CANVAS = (2, 1, 2)
NAN, INF = float("nan"), float("inf")


def one_body(code: int = 1) -> tuple[Any, Any]:
    return np.full((1, *CANVAS), code, np.uint8), np.zeros((1, *CANVAS))


NOT_NEGATIVE = ([-1e-9, NAN, INF, -INF], "finite and not negative")
SETTINGS: dict[str, tuple[list[float], str]] = {
    "voxel_size": ([0.0, -0.05, NAN, INF, 9e-7, 1.1e6], "between 1e-6 and 1e6 m"),
    "time_step_fraction": ([0.0, -0.9, 1.0001, NAN], "above 0 and at most 1"),
    "substeps": ([0, -1, 1001, 2**62], "between 1 and 1000"),
    "step_limit": ([0, -1, -(2**62)], "at least 1"),
    "duration": ([0.0, -1.0, NAN, INF, 1.1e9], "above 0 and at most 1e9 s"),
    "temperature_amplitude": ([NAN, INF, -INF], "finite"),
    "period": ([0.0, -0.25, NAN, INF, 9e-10, 1.1e9], "between 1e-9 and 1e9 s"),
    "start_time": ([-1e-9, NAN, INF, 1.1e9], "between 0 and 1e9 s"),
    "ramp": ([-1e-9, NAN, INF, 1.1e9], "between 0 and 1e9 s"),
    "smallest_size": ([0.0, 9e-4, 1.1, NAN], "between 1e-3 and 1"),
    "largest_size": ([0.9, 10.1, NAN, INF], "between 1 and 10"),
    "gravity": ([NAN, INF, -INF], "finite"),
    "floor_slope": ([-89.1, 89.1, 90.0, NAN, INF], "between -89 and 89 degrees"),
    "falling_code": ([-1, 256], "between 0 and 255"),
    "fluid_drag": NOT_NEGATIVE,
    "bond_damping": NOT_NEGATIVE,
    "slow_damping": NOT_NEGATIVE,
    "floor_damping": NOT_NEGATIVE,
    "contact_damping": NOT_NEGATIVE,
    "collision_envelope": ([0.99, 2.01, NAN, INF], "between 1 and 2"),
    "collision_horizon": ([0.99, 10.01, NAN], "between 1 and 10"),
    "collision_list_factor": ([0.99, 2.01, NAN], "between 1 and 2"),
    "largest_strain": ([0.0, -1.0, NAN, INF, 1.1e9], "above 0 and at most 1e9"),
    "largest_distance": ([0.0, -1.0, NAN, INF, 1.1e9], "above 0 and at most 1e9"),
}
MATERIALS: dict[str, tuple[list[float], str]] = {
    "youngs_modulus": ([0.0, -1.0, NAN, INF, 9e-7, 1.1e18], "between 1e-6 and 1e18 Pa"),
    "poisson_ratio": ([-0.01, 0.51, NAN], "between 0 and 0.5"),
    "density": ([0.0, -1.0, NAN, INF, 9e-7, 1.1e18], "between 1e-6 and 1e18 kg/m3"),
    "expansion": ([NAN, INF, 1e308], "finite"),
    "static_friction": NOT_NEGATIVE,
    "dynamic_friction": NOT_NEGATIVE,
}
EXTREMES: dict[str, list[float]] = {
    "voxel_size": [1e-6, 1e6],
    "time_step_fraction": [1e-300, 1.0],
    "substeps": [1, 1000],
    "step_limit": [1, 2**63 - 1],
    "duration": [1e-300, 1e9],
    "period": [1e-9, 1e9],
    "start_time": [0.0, 1e9],
    "ramp": [0.0, 1e9],
    "smallest_size": [1e-3, 1.0],
    "largest_size": [1.0, 10.0],
    "floor_slope": [-89.0, 89.0],
    "falling_code": [0, 255],
    "collision_envelope": [1.0, 2.0],
    "collision_horizon": [1.0, 10.0],
    "collision_list_factor": [1.0, 2.0],
    "largest_strain": [1e-300, 1e9],
    "largest_distance": [1e-300, 1e9],
}


def test_every_setting_and_property_has_its_range_tested() -> None:
    switches = {"floor", "self_collision", "contact_friction", "complete_contacts"}
    switches |= {"size_clamp", "fluid_by_size"}
    assert {field.name for field in attrs.fields(Settings)} == SETTINGS.keys() | switches
    assert {field.name for field in attrs.fields(Material)} == MATERIALS.keys()


@pytest.mark.parametrize(("ranges", "cases"), [(SETTING_RANGES, SETTINGS), (PROPERTY_RANGES, MATERIALS)])
def test_ranges_agree_with_the_solver(
    ranges: Mapping[str, Range], cases: dict[str, tuple[list[float], str]]
) -> None:
    assert ranges.keys() == cases.keys()
    for field, (values, words) in cases.items():
        assert words in ranges[field].words
        rejected = set(values) - ({1e308} if field == "expansion" else set())  # times the amplitude
        assert [value for value in rejected if value in ranges[field]] == []
        assert all(value in ranges[field] for value in EXTREMES.get(field, []))


@given(data=st.data(), field=st.sampled_from(sorted(SETTING_RANGES)))
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_a_number_outside_the_range_is_rejected(
    small_model: ModelMaker, data: st.DataObject, field: str
) -> None:
    """Numbers in the range are accepted; time steps are checked later, for each body."""
    span = SETTING_RANGES[field]
    bounds = [bound for bound in (span.lower, span.upper) if math.isfinite(bound)]
    near = [math.nextafter(bound, way) for bound in bounds for way in (-INF, INF)]
    numbers = st.integers(-(2**63), 2**63 - 1) if span.whole else st.floats() | st.sampled_from([0.0, *near])
    value = data.draw(numbers | st.sampled_from([int(b) if span.whole else b for b in bounds] or [0]))
    if value in span:
        small_model(CANVAS, **{field: value})
    else:
        with pytest.raises(ValueError, match=f"^{field} .*{re.escape(span.words)}, got "):
            small_model(CANVAS, **{field: value})


def test_only_integers_are_in_the_range_of_steps() -> None:
    assert {name for name, span in SETTING_RANGES.items() if span.whole} == {
        "substeps",
        "step_limit",
        "falling_code",
    }
    assert 1.5 not in SETTING_RANGES["substeps"]
    assert 2 in SETTING_RANGES["substeps"]
    assert NAN not in SETTING_RANGES["substeps"]


@pytest.mark.parametrize("field", SETTINGS)
def test_settings_out_of_range(small_model: ModelMaker, field: str) -> None:
    values, words = SETTINGS[field]
    for value in values:
        with pytest.raises(ValueError, match=rf"^{field} .*{re.escape(words)}.*, got {value}$"):
            small_model(CANVAS, **{field: value})


@pytest.mark.parametrize("field", EXTREMES)
def test_settings_at_the_bounds_of_their_range(small_model: ModelMaker, field: str) -> None:
    for value in EXTREMES[field]:
        assert getattr(small_model(CANVAS, **{field: value}).settings, field) == value


@pytest.mark.parametrize("field", MATERIALS)
def test_materials_out_of_range(small_model: ModelMaker, material: Callable[..., object], field: str) -> None:
    values, words = MATERIALS[field]
    for value in values:
        expected = rf"^{field}.*{re.escape(words)}.*, got {re.escape(str(value))} for material 9$"
        with pytest.raises(ValueError, match=expected):
            small_model(CANVAS, palette={1: material(), 9: material(**{field: value})})


@pytest.mark.parametrize("canvas", [(0, 1, 1), (1, -1, 1), (1, 1, 0)])
def test_canvas_without_cells(
    small_settings: Callable[..., Settings], palette: dict[int, Material], canvas: tuple[int, int, int]
) -> None:
    with pytest.raises(ValueError, match=r"canvas .* 1 cell"):
        Model(canvas, palette, small_settings(), np.zeros(tuple(max(n, 0) for n in canvas), np.uint8))


def test_canvas_too_large(small_model: ModelMaker) -> None:
    with pytest.raises(ValueError, match=r"canvas .* 2\^24 cells, got \(4096, 4097, 1\)"):
        small_model((4096, 4097, 1))


@pytest.mark.parametrize("code", [0, -1, 256])
def test_palette_codes_out_of_range(
    small_model: ModelMaker, material: Callable[..., object], code: int
) -> None:
    with pytest.raises(ValueError, match=rf"palette .* 1 to 255, got {code}"):
        small_model(CANVAS, palette={code: material()})


def test_empty_palette(small_settings: Callable[..., Any]) -> None:
    with pytest.raises(ValueError, match="palette"):
        Model(CANVAS, {}, small_settings(), np.zeros(CANVAS, np.uint8))


def test_fixed_must_be_a_mask(small_settings: Callable[..., Any], palette: dict[int, Any]) -> None:
    with pytest.raises(ValueError, match=r"^fixed .*\[2, 1, 2\], got \[2, 1\]"):
        Model(CANVAS, palette, small_settings(), np.zeros((2, 1), np.uint8))
    for dtype in (np.float64, np.int64, np.bool_):
        with pytest.raises(ValueError, match=f"^fixed .* uint8, got {np.dtype(dtype)}"):
            Model(CANVAS, palette, small_settings(), np.zeros(CANVAS, dtype))


@pytest.mark.parametrize("mask", [64, 128, 255])
def test_fixed_has_six_bits(small_settings: Callable[..., Any], palette: dict[int, Any], mask: int) -> None:
    fixed = np.zeros(CANVAS, np.uint8)
    fixed[0, 0, 1] = mask
    with pytest.raises(ValueError, match=r"^fixed .* 63.* \(cell 2 "):
        Model(CANVAS, palette, small_settings(), fixed)


def test_unknown_material_names_the_body(small_model: ModelMaker) -> None:
    material, phase = (np.repeat(a, 3, axis=0) for a in one_body())
    material[2, 0, 0, 1] = 2
    model = small_model(CANVAS)
    with pytest.raises(ValueError, match=r"material code .* \(body 2\)"):
        model.time_steps(material)
    with pytest.raises(ValueError, match=r"material code .* \(body 2\)"):
        model.simulate(material, phase, [0])


def test_empty_body(small_model: ModelMaker) -> None:
    material, phase = one_body(0)
    with pytest.raises(ValueError, match=r"no voxels \(body 0\)"):
        small_model(CANVAS).simulate(material, phase, [0])


@pytest.mark.parametrize("phase", [NAN, INF, -INF, 1.1e6, -1e300])
def test_absurd_phase(small_model: ModelMaker, phase: float) -> None:
    material, phases = one_body(3)
    phases[0, 1, 0, 0] = phase
    with pytest.raises(ValueError, match=r"phase .* 1e6 cycles \(body 0\)"):
        small_model(CANVAS).simulate(material, phases, [0])


@pytest.mark.parametrize("steps", [[-1], [0, 0], [2, 1]])
def test_samples_out_of_order(small_model: ModelMaker, steps: list[int]) -> None:
    with pytest.raises(ValueError, match="strictly ascending"):
        small_model(CANVAS).simulate(*one_body(), steps)


def test_samples_of_each_body_are_checked(small_model: ModelMaker) -> None:
    material, phase = (np.repeat(a, 3, axis=0) for a in one_body())
    model = small_model(CANVAS)
    with pytest.raises(ValueError, match=r"sample_steps .*strictly ascending.* \(body 1\)"):
        model.simulate(material, phase, np.array([[0, 1], [1, 1], [0, 1]]))
    with pytest.raises(ValueError, match=r"sample_steps .*beyond.* \(body 2\)"):
        model.simulate(material, phase, np.array([[0, 1], [0, 2], [0, 999]]))


def test_samples_end_with_the_simulation(small_model: ModelMaker) -> None:
    model = small_model(CANVAS)
    last = int(model.time_steps(one_body()[0])[1][0])
    assert model.simulate(*one_body(), [last]).tracks["tip"].shape == (1, 1, 3)
    with pytest.raises(ValueError, match=r"sample_steps .*beyond.* \(body 0\)"):
        model.simulate(*one_body(), [last + 1])


def test_time_step_must_be_usable(small_model: ModelMaker, material: Callable[..., object]) -> None:
    endless = small_model(CANVAS, time_step_fraction=1e-300)
    long = small_model(CANVAS, duration=1e9, palette={1: material(density=1e-6, youngs_modulus=1e18)})
    for model in (endless, long):
        with pytest.raises(ValueError, match=r"time step .* \(body 0\)"):
            model.simulate(*one_body(), [])


@pytest.mark.parametrize("dtype", [np.int64, np.uint16, np.float64])
def test_material_codes_are_not_converted(small_model: ModelMaker, dtype: type) -> None:
    material, phase = one_body()
    with pytest.raises(ValueError, match=f"^material .* uint8, got {np.dtype(dtype)}"):
        small_model(CANVAS).simulate(material.astype(dtype), phase, [0])


def test_shapes_must_fit(small_model: ModelMaker) -> None:
    material, phase = one_body()
    model = small_model(CANVAS)
    with pytest.raises(ValueError, match=r"^material .*\[N, 2, 1, 2\], got \[2, 1, 2\]"):
        model.simulate(material[0], phase, [0])
    with pytest.raises(ValueError, match=r"^phase_cycles .*\[1, 2, 1, 2\], got \[2, 2, 1, 2\]"):
        model.simulate(material, np.repeat(phase, 2, axis=0), [0])
    with pytest.raises(ValueError, match=r"^sample_steps .*\[1, N\], got \[2, 1\]"):
        model.simulate(material, phase, np.zeros((2, 1), np.int64))
    with pytest.raises(ValueError, match=r"^sample_steps .*\[N\], got \[1, 1, 1\]"):
        model.simulate(material, phase, np.zeros((1, 1, 1), np.int64))
    with pytest.raises(ValueError, match=r"^sample_steps .* int64, got float64"):
        model.simulate(material, phase, [0.0])  # type: ignore[list-item]  # the error under test


def test_unknown_track(small_model: ModelMaker) -> None:
    with pytest.raises(ValueError, match=r" elbow, knee; .* tip, face, body, voxels, "):
        small_model(CANVAS).simulate(*one_body(), [0], ["knee", "elbow"])  # type: ignore[list-item]  # the error under test


def test_arrays_may_have_any_layout(small_model: ModelMaker) -> None:
    rng = np.random.default_rng(2)
    material = rng.choice(np.array([1, 3], np.uint8), (3, 3, 2, 4))
    phase = rng.uniform(-1.0, 1.0, material.shape).astype(np.float32)
    model = small_model(material.shape[1:])
    plain = model.simulate(material, phase, range(9)).tracks
    odd = model.simulate(np.asfortranarray(material), phase[::-1][::-1], list(range(9))).tracks
    assert all(np.array_equal(plain[name], odd[name]) for name in plain)


def test_public_names() -> None:
    assert evoframe_libvox.KERNELS[0] == "scalar"
    assert all(hasattr(evoframe_libvox, name) for name in evoframe_libvox.__all__)


def test_a_mask_of_booleans_is_rejected(small_settings: Callable[..., Any], palette: dict[int, Any]) -> None:
    with pytest.raises(ValueError, match=r"^fixed .* uint8, got bool"):
        Model(CANVAS, palette, small_settings(), np.zeros(CANVAS, bool))


def test_the_words_of_a_range_agree_with_the_readme() -> None:
    assert 0.07 in SETTING_RANGES["duration"]
    assert SETTING_RANGES["duration"].words == "above 0 and at most 1e9 s"
