"""Options of `vox` in configurations, and errors in them."""

from __future__ import annotations

import math
import pickle
import tomllib
from importlib.resources import files

import attrs
import numpy as np
import pytest
from bars import bar, soft
from hypothesis import given, strategies as st

from evoframe import ConfigurationError, load_config
from evoframe_simulators import FixedRegion, Vox, VoxSettings
from evoframe_simulators.vox.settings import amplitude_of, materials_of, period_of, phase_cycles

STEEL = "code=2, youngs_modulus=5e7, poisson_ratio=0.3, density=1e6, static_friction=1, dynamic_friction=0.5"


class TestConfiguration:
    def test_the_preset_contains_every_option_with_its_default(self) -> None:
        assert load_config("paper").simulator.component == Vox()
        text = files("evoframe").joinpath("config", "presets", "paper.toml").read_text(encoding="utf-8")
        written = tomllib.loads(text)["simulator"]
        assert {*written} == {"name", *(field.name for field in attrs.fields(Vox))}

    def test_a_palette_and_regions_are_tables(self) -> None:
        palette = f"simulator.palette=[{{{STEEL}, expansion_coefficient=0.01, name='steel'}}]"
        fixed = "simulator.fixed=[{}, {origin=[0.5, 0, 0], size=[0.5, 1, 1], degrees_of_freedom=['x', 'rz']}]"
        vox = load_config("paper", overrides=[palette, fixed]).simulator.component
        assert isinstance(vox, Vox)
        expected = soft(2, youngs_modulus=5e7, poisson_ratio=0.3, expansion_coefficient=0.01, name="steel")
        assert vox.palette == (expected,)
        assert vox.fixed == (FixedRegion(), FixedRegion((0.5, 0.0, 0.0), (0.5, 1.0, 1.0), ("x", "rz")))

    @pytest.mark.parametrize(
        ("override", "messages"),
        [
            (f"palette=[{{{STEEL}}}]", ["simulator.palette[0].expansion_coefficient", "missing"]),
            ("palette=[{code=0}]", ["simulator.palette[0].code: ", ">= 1, found 0"]),
            ("palette=[{code=256}]", ["simulator.palette[0].code: ", "<= 255, found 256"]),
            (
                "palette=[{density=-1}]",
                ["simulator.palette[0].density: ", "1e-6 and 1e18 kg/m3, found -1.0"],
            ),
            ("palette=[{colour=1}]", ["simulator.palette[0].colour: "]),
            ("palette=[{name='a\\u0007'}]".replace("'", '"'), ["simulator.palette[0].name: ", "printable"]),
            ("fixed=[{size=[1, -1, 1]}]", ["simulator.fixed[0].size: ", ">= 0.0, found -1.0"]),
            ("fixed=[{size=[1, 1]}]", ["simulator.fixed[0].size: ", "list of 3"]),
            (
                "fixed=[{degrees_of_freedom=['x', 'w']}]",
                ["simulator.fixed[0].degrees_of_freedom[1]: ", 'found "w"'],
            ),
            (
                "fixed=[{degrees_of_freedom=['x', 'x']}]",
                ["simulator.fixed[0].degrees_of_freedom: ", "duplicates"],
            ),
            ("collision_envelope=2.5", ["simulator.collision_envelope: ", "1 and 2, found 2.5"]),
            ("collision_horizon=0.5", ["simulator.collision_horizon: ", "1 and 10, found 0.5"]),
            ("floor_slope=90", ["simulator.floor_slope: ", "-89 and 89 degrees, found 90.0"]),
            ("substeps=0", ["simulator.substeps: ", "1 and 1000, found 0"]),
            ("start_time=-1", ["simulator.start_time: ", "0 and 1e9 s, found -1.0"]),
            ("duration=1e10", ["simulator.duration: ", "1e9 s, found 10000000000.0"]),
            ("collision_damping=-1", ["simulator.collision_damping: ", "found -1.0"]),
            ("poisson_ratio=0.6", ["simulator.poisson_ratio: ", "0.5, found 0.6"]),
            ("step_limit=0", ["simulator.step_limit: ", "at least 1, found 0"]),
            (f"step_limit={2**53 + 1}", ["simulator.step_limit: ", f"<= {2**53}, found {2**53 + 1}"]),
            ("frequency=0", ["simulator.frequency: ", "> 0.0, found 0.0"]),
            (
                "step_limit=20",
                ["simulator: ", "duration = 0.07 s ", "22 steps", "step_limit = 20"],
            ),
            ("frequency=1e-60", ["simulator: ", "period"]),
            ("temperature_amplitude=1e60", ["simulator: ", "temperature_amplitude"]),
        ],
    )
    def test_errors_contain_key_and_values(self, override: str, messages: list[str]) -> None:
        with pytest.raises(ConfigurationError) as caught:
            load_config("paper", overrides=[f"simulator.{override}"])
        for message in messages:
            assert message in str(caught.value)


class TestPalette:
    def test_it_replaces_the_built_in_materials_of_a_preset(self) -> None:
        assert materials_of(Vox(palette=(soft(1),), density=1000.0)) == {1: soft(1)}

    def test_a_limit_of_steps_that_suffices_is_accepted(self) -> None:
        assert Vox(step_limit=22).step_limit == 22


class TestValue:
    def test_a_simulator_has_the_options_of_its_settings(self) -> None:
        own, inherited = (
            [(field.name, field.type, field.default) for field in attrs.fields(attrs.resolve_types(owner))]
            for owner in (VoxSettings, Vox)
        )
        assert own == inherited

    def test_only_the_simulator_rejects_settings_that_the_solver_rejects(self) -> None:
        assert VoxSettings(frequency=1e-60).frequency == 1e-60
        with pytest.raises(ValueError, match="period"):
            Vox(frequency=1e-60)

    def test_equal_settings_have_one_hash(self) -> None:
        assert hash(VoxSettings(frequency=2.0)) == hash(VoxSettings(frequency=2.0))
        assert VoxSettings(frequency=2.0) != VoxSettings()
        assert hash(pickle.loads(pickle.dumps(Vox()))) == hash(Vox())  # noqa: S301 - workers receive it pickled


class TestWholeBody:
    def test_determines_a_result_only_if_it_is_set(self) -> None:
        default, same, whole = (
            load_config("paper", overrides=overrides)
            for overrides in ([], ["simulator.whole_body=false"], ["simulator.whole_body=true"])
        )
        assert "whole_body" not in default.recorded()["simulator"]
        assert same.deciding() == default.deciding()
        assert whole.recorded()["simulator"]["whole_body"] is True


class TestMaterials:
    def test_the_built_in_materials_differ_only_in_expansion(self) -> None:
        passive, contractile = materials_of(VoxSettings(density=7.0)).values()
        assert (passive.code, passive.name, contractile.code, contractile.name) == (
            *(1, "passive"),
            *(3, "contractile"),
        )
        assert passive.expansion_coefficient == 0.0
        assert attrs.evolve(contractile, code=1, name="passive", expansion_coefficient=0.0) == passive

    def test_materials_of_a_palette_are_found_by_code(self) -> None:
        assert materials_of(VoxSettings(palette=(soft(9), soft(2)))) == {9: soft(9), 2: soft(2)}


class TestDerived:
    @given(offset=st.floats(-1e6, 1e6))
    def test_radians_are_cycles_times_two_pi(self, offset: float) -> None:
        design = bar(3).with_role("controller", np.full((1, 1, 1), offset))
        [cycles], [from_radians] = (
            phase_cycles(VoxSettings(phase_unit=unit), design).ravel() for unit in ("cycles", "radians")
        )
        assert cycles == offset
        assert from_radians == offset / math.tau

    @given(base=st.floats(-1e3, 1e3), highest=st.floats(-1e3, 1e3), frequency=st.floats(1e-3, 1e3))
    def test_amplitude_and_period_have_single_precision(
        self, base: float, highest: float, frequency: float
    ) -> None:
        settings = VoxSettings(temperature_base=base, temperature_amplitude=highest, frequency=frequency)
        assert amplitude_of(settings) == np.float32(highest - base)
        assert period_of(settings) == np.float32(1 / frequency)
