"""Contents of a VXA file, and its settings."""

from __future__ import annotations

from typing import Any

import attrs
import numpy as np
import pytest
from hypothesis import given, strategies as st

from evoframe import InputError
from evoframe_simulators import VoxSettings
from evoframe_simulators.vox.models import clock_of
from evoframe_simulators.vox.settings import materials_of
from evoframe_simulators.vox.vxa import VxaFile

BAR = np.array([1, 3, 3], np.uint8).reshape(3, 1, 1)


MATERIALS: list[dict[str, Any]] = [attrs.asdict(each) for each in materials_of(VoxSettings()).values()]


def file(steps: int | None = None, **options: Any) -> VxaFile:
    """Return a file with the paper's materials and duration, changed by the options."""
    materials = [{**each, **{name: options[name] for name in each if name in options}} for each in MATERIALS]
    given = {name: value for name, value in options.items() if name not in MATERIALS[0]}
    duration = {} if steps is not None else {"duration": VoxSettings().duration}
    return VxaFile({**duration, **given}, tuple(materials), BAR, np.zeros(BAR.shape), steps)


def without_palette(settings: VoxSettings) -> VoxSettings:
    return attrs.evolve(settings, palette=())


def test_settings_are_the_options_and_the_defaults_of_others() -> None:
    assert without_palette(file().settings()) == VoxSettings()
    changed = file(frequency=2.0, duration=0.5).settings()
    assert without_palette(changed) == VoxSettings(frequency=2.0, duration=0.5)
    assert [material.code for material in changed.palette] == [1, 3]
    assert file().canvas == (3, 1, 1)


@given(steps=st.integers(1, 10**6), fraction=st.floats(0.1, 1.0))
def test_a_number_of_steps_becomes_a_duration_with_this_number(steps: int, fraction: float) -> None:
    settings = file(steps, time_step_fraction=fraction).settings()
    clock = clock_of(settings, BAR)
    assert clock.total == steps
    assert settings.duration == (steps - 0.5) * clock.time_step


def test_a_number_of_steps_does_not_depend_on_the_default_duration() -> None:
    options: dict[str, Any] = {"voxel_size": 1e-6, "youngs_modulus": 1e18, "density": 1e-6}
    with pytest.raises(InputError, match=r"time step \(.*2\^53 steps\)$"):
        file(**options).settings()
    assert clock_of(file(20, **options).settings(), BAR).total == 20


@pytest.mark.parametrize(
    ("steps", "options", "message"),
    [
        (None, {"voxel_size": -1.0}, "out of range: .* 1e-6 and 1e6 m"),
        (None, {"frequency": 1e-60}, "^TempPeriod "),
        (7, {"frequency": 1e-60}, "^TempPeriod "),
        (10**9, {}, r"^StopConditionValue = .* 1000000000 steps, .* step_limit = 10000000;"),
    ],
)
def test_settings_that_cannot_be_simulated_are_rejected(
    steps: int | None, options: Any, message: str
) -> None:
    with pytest.raises(InputError, match=message):
        file(steps, **options).settings()


class TestOverrides:
    """Options that the user sets, known before the file is judged."""

    def test_answer_what_is_missing(self) -> None:
        endless = attrs.evolve(file(), options={})
        with pytest.raises(InputError) as caught:
            endless.settings()
        assert caught.value.key == "Simulator/StopCondition"
        assert endless.toml({"duration": 0.5})["duration"] == 0.5

    def test_replace_what_is_out_of_range(self) -> None:
        wrong = file(time_step_fraction=1.5)
        with pytest.raises(InputError) as caught:
            wrong.toml()
        assert caught.value.key == "Simulator/Integration/DtFrac"
        assert wrong.toml({"time_step_fraction": 0.5})["time_step_fraction"] == 0.5

    def test_may_replace_the_palette_and_the_regions(self) -> None:
        palette = [{**each, "youngs_modulus": 1e7, "name": ""} for each in MATERIALS]
        fixed = [{"origin": [0.5, 0.0, 0.0]}]
        found = file(youngs_modulus=-1.0).toml({"palette": palette, "fixed": fixed})
        assert [each["youngs_modulus"] for each in found["palette"]] == [1e7, 1e7]
        assert [region["origin"] for region in found["fixed"]] == [[0.5, 0.0, 0.0]]

    @pytest.mark.parametrize(
        "given",
        [
            {"duration": -1.0},
            {"duration": "long"},
            {"palette": 3},
            {"palette": [{"code": 1}]},
            {"fixed": [{"size": 1}]},
            {"fixed": "none"},
            {"unknown": 1},
        ],
    )
    def test_that_are_invalid_are_left_to_the_core(self, given: dict[str, Any]) -> None:
        found = file().toml(given)
        assert {**found, **given}.items() >= given.items()

    def test_change_the_time_step_of_a_number_of_steps(self) -> None:
        stiff = file(7).toml({"palette": [{**each, "youngs_modulus": 5e8} for each in MATERIALS]})
        assert stiff["duration"] == pytest.approx(file(7).toml()["duration"] / 10, rel=1e-12)

    def test_are_named_by_their_option_in_errors_of_the_solver(self) -> None:
        with pytest.raises(InputError, match=r"^duration = 10\.0 s requires"):
            file(step_limit=10).toml({"duration": 10.0})


def test_all_faults_are_reported_in_the_words_of_the_file() -> None:
    with pytest.raises(InputError) as caught:
        file(time_step_fraction=1.5, slow_damping=-1.0, poisson_ratio=0.7).settings()
    lines = caught.value.problem.splitlines()
    assert [line.split(":")[0].strip() for line in lines[2:]] == [
        "Simulator/Integration/DtFrac",
        "Simulator/Damping/SlowDampingZ",
        "VXC/Palette/Material 1/Mechanical/Poissons_Ratio",
        "VXC/Palette/Material 3/Mechanical/Poissons_Ratio",
    ]


def test_a_body_alone_sets_only_its_own_options() -> None:
    body = attrs.evolve(file(voxel_size=0.01), complete=False)
    found = body.toml()
    assert set(found) == {"voxel_size", "palette"}
    assert found["voxel_size"] == 0.01
