"""The options of `vox`: what they are in a configuration, and what is refused where."""

from __future__ import annotations

import tomllib
from importlib.resources import files
from typing import Any

import attrs
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from evoframe import ConfigurationError, Design, InputError, Record, load_config
from evoframe_simulators import FixedRegion, PaletteMaterial, Vox
from evoframe_simulators.vox import materials_of
from evoframe_simulators.vox.models import possible_clocks
from evoframe_simulators.vox.regions import DEGREES_OF_FREEDOM, fixed_mask

STEEL = "code=2, youngs_modulus=5e7, poisson_ratio=0.3, density=1e6, static_friction=1, dynamic_friction=0.5"


def material(code: int, **changed: Any) -> PaletteMaterial:
    soft: dict[str, Any] = {
        "youngs_modulus": 5e6,
        "poisson_ratio": 0.35,
        "density": 1e6,
        "expansion_coefficient": 0.0,
        "static_friction": 1.0,
        "dynamic_friction": 0.5,
    }
    return PaletteMaterial(code=code, **{**soft, **changed})


def bar(*codes: int) -> Design:
    cells = np.array(codes, np.uint8).reshape(-1, 1, 1)
    return Design({"morphology": cells, "controller": np.zeros(cells.shape)})


class TestConfiguration:
    def test_the_preset_writes_every_option_out_with_its_default(self) -> None:
        assert load_config("paper").simulator.component == Vox()
        text = files("evoframe").joinpath("config", "presets", "paper.toml").read_text(encoding="utf-8")
        written = tomllib.loads(text)["simulator"]
        assert {*written} == {"name", *(field.name for field in attrs.fields(Vox))}

    def test_a_palette_and_regions_are_tables(self) -> None:
        palette = f"simulator.palette=[{{{STEEL}, expansion_coefficient=0.01, name='steel'}}]"
        fixed = "simulator.fixed=[{}, {origin=[0.5, 0, 0], size=[0.5, 1, 1], degrees_of_freedom=['x', 'rz']}]"
        vox = load_config("paper", overrides=[palette, fixed]).simulator.component
        assert isinstance(vox, Vox)
        expected = material(
            2, youngs_modulus=5e7, poisson_ratio=0.3, expansion_coefficient=0.01, name="steel"
        )
        assert vox.palette == (expected,)
        assert vox.fixed == (FixedRegion(), FixedRegion((0.5, 0.0, 0.0), (0.5, 1.0, 1.0), ("x", "rz")))

    @pytest.mark.parametrize(
        ("override", "messages"),
        [
            (f"palette=[{{{STEEL}}}]", ["simulator.palette[0].expansion_coefficient", "is missing"]),
            ("palette=[{code=0}]", ["simulator.palette[0].code: must be >= 1, found 0"]),
            ("palette=[{code=256}]", ["simulator.palette[0].code: must be <= 255, found 256"]),
            ("palette=[{density=-1}]", ["simulator.palette[0].density: must be > 0.0, found -1.0"]),
            ("palette=[{colour=1}]", ["simulator.palette[0].colour: unknown option"]),
            ("palette=[{name='a\\u0007'}]".replace("'", '"'), ["must be one line of printable characters"]),
            ("fixed=[{size=[1, -1, 1]}]", ["simulator.fixed[0].size: must be >= 0.0, found -1.0"]),
            ("fixed=[{size=[1, 1]}]", ["simulator.fixed[0].size: expected a list of 3"]),
            (
                "fixed=[{degrees_of_freedom=['x', 'w']}]",
                ["simulator.fixed[0].degrees_of_freedom[1]: expected one of", 'found "w"'],
            ),
            (
                "fixed=[{degrees_of_freedom=['x', 'x']}]",
                ["simulator.fixed[0].degrees_of_freedom: must have each"],
            ),
            ("collision_envelope=2.5", ["simulator.collision_envelope: must be <= 2.0, found 2.5"]),
            ("collision_horizon=0.5", ["simulator.collision_horizon: must be >= 1.0, found 0.5"]),
            ("floor_slope=90", ["simulator.floor_slope: must be <= 89.0, found 90.0"]),
            ("substeps=0", ["simulator.substeps: must be >= 1, found 0"]),
            ("start_time=-1", ["simulator.start_time: must be >= 0.0"]),
            (
                "step_limit=20",
                ["simulator: duration = 0.07 s takes 22 steps, more than step_limit = 20; simulate"],
            ),
            ("frequency=1e-60", ["simulator: ", "period must be"]),
            ("temperature_amplitude=1e60", ["simulator: ", "temperature_amplitude must be"]),
        ],
    )
    def test_what_is_wrong_is_named_with_its_key(self, override: str, messages: list[str]) -> None:
        with pytest.raises(ConfigurationError) as caught:
            load_config("paper", overrides=[f"simulator.{override}"])
        for message in messages:
            assert message in str(caught.value)


class TestPalette:
    def test_one_code_for_two_materials_is_refused(self) -> None:
        with pytest.raises(ValueError, match="expected one material for each code, found 2 for 4"):
            Vox(palette=(material(4), material(2), material(4)))

    def test_it_stands_for_what_a_preset_says_of_the_built_in_materials(self) -> None:
        assert materials_of(Vox(palette=(material(1),), density=1000.0)) == {1: material(1)}

    def test_a_limit_of_steps_that_suffices_is_accepted(self) -> None:
        assert Vox(step_limit=22).step_limit == 22

    def test_the_built_in_materials_are_one(self) -> None:
        palette = (material(1), material(3, expansion_coefficient=0.01))
        record = Record(("tip", "energy"))
        [own], [built_in] = (v.simulate([bar(1, 3, 3)], record) for v in (Vox(palette=palette), Vox()))
        for track in record.tracks:
            assert (own.tracks[track] == built_in.tracks[track]).all()

    def test_only_its_codes_are_simulated(self) -> None:
        vox = Vox(palette=(material(200), material(7)))
        assert vox.simulate([bar(200, 7)], Record(("tip",)))[0].diverged_at is None
        with pytest.raises(InputError, match=r"^material has the code 1; codes: 0 empty, 7, 200$"):
            vox.simulate([bar(1, 7)], Record(("tip",)))

    def test_a_phase_counts_where_the_material_expands_or_contracts(self) -> None:
        vox = Vox(palette=(material(1), material(2, expansion_coefficient=-0.01), material(3)))
        body = bar(1, 2, 3)
        keys = [
            vox.key(body.with_role("controller", np.eye(3)[n].reshape(3, 1, 1)), Record(("tip",)))
            for n in range(3)
        ]
        assert keys[0] == keys[2] == vox.key(body, Record(("tip",)))
        assert keys[1] != keys[0]

    def test_without_an_amplitude_no_phase_counts(self) -> None:
        vox = Vox(temperature_amplitude=25.0)
        turned = bar(3, 3).with_role("controller", np.ones((2, 1, 1)))
        assert vox.key(turned, Record(("tip",))) == vox.key(bar(3, 3), Record(("tip",)))

    def test_bodies_of_one_batch_may_have_different_time_steps(self) -> None:
        vox = Vox(palette=(material(1), material(2, youngs_modulus=5e7, expansion_coefficient=0.01)))
        bodies = [bar(1, 1), bar(2, 2), bar(1, 2), bar(2, 1)]
        for record in (Record(("tip",)), Record(("tip",), every=0.02, samples=(0, 1), initial=True)):
            together = vox.simulate(bodies, record)
            assert len({outcome.times[-1] for outcome in together}) == 3
            for body, outcome in zip(bodies, together, strict=True):
                [alone] = vox.simulate([body], record)
                assert (alone.steps == outcome.steps).all()
                assert (alone.tracks["tip"] == outcome.tracks["tip"]).all()

    def test_a_record_must_suit_every_pair_of_its_materials(self) -> None:
        heavy = material(2, density=1e8)
        clocks = possible_clocks(Vox(palette=(material(1), heavy, attrs.evolve(heavy, code=3))))
        assert len(clocks) == 3 + 2  # pairs, and each alone; equal materials count once
        with pytest.raises(ConfigurationError, match="vox makes 3 steps"):
            Vox(palette=(material(1), heavy)).check(Record(("tip",), samples=(3,)))


class TestFixedRegions:
    def test_by_default_the_slab_at_x_0_is_clamped(self) -> None:
        mask = fixed_mask([FixedRegion()], (5, 3, 2))
        assert (mask[0] == 63).all()
        assert not mask[1:].any()

    def test_none_leave_the_body_free(self) -> None:
        vox = Vox(fixed=(), gravity=-10.0, duration=0.5, self_collision=False, slow_damping=0.0)
        [outcome] = vox.simulate([bar(1, 1)], Record(("body",), initial=True))
        fallen = outcome.tracks["body"][-1, 2] - outcome.tracks["body"][0, 2]
        assert fallen == pytest.approx(-5.0 * outcome.times[-1] ** 2, rel=0.01)

    def test_single_degrees_of_freedom_are_held(self) -> None:
        region = FixedRegion(size=(1.0, 1.0, 1.0), degrees_of_freedom=("x", "z"))
        vox = Vox(fixed=(region,), gravity=-10.0, self_collision=False)
        [outcome] = vox.simulate([bar(1, 3)], Record(("tip",), initial=True))
        moved = np.ptp(outcome.tracks["tip"], axis=0)
        assert moved.tolist() == [0.0, 0.0, 0.0]

    @given(
        regions=st.lists(
            st.builds(
                FixedRegion,
                st.tuples(*[st.floats(-0.5, 1.5)] * 3),
                st.tuples(*[st.floats(0, 1.5)] * 3),
                st.sets(st.sampled_from(DEGREES_OF_FREEDOM)).map(tuple),
            ),
            max_size=3,
        ),
        canvas=st.tuples(*[st.integers(1, 4)] * 3),
    )
    def test_a_cell_is_held_by_the_regions_that_it_overlaps(
        self, regions: list[FixedRegion], canvas: tuple[int, int, int]
    ) -> None:
        expected = np.zeros(canvas, np.uint8)
        for cell in np.ndindex(canvas):
            for region in regions:
                spans = zip(cell, canvas, region.origin, region.size, strict=True)
                if all((i + 1) / n > start and i / n < start + length for i, n, start, length in spans):
                    expected[cell] |= region.bits
        assert (fixed_mask(regions, canvas) == expected).all()

    def test_bits_are_those_of_the_engine(self) -> None:
        bits = [FixedRegion(degrees_of_freedom=(freedom,)).bits for freedom in DEGREES_OF_FREEDOM]
        assert bits == [1, 2, 4, 8, 16, 32]


class TestTracks:
    record = Record(("tip", "voxels", "energy", "strain", "momentum"), initial=True)

    def test_further_tracks_have_their_documented_shapes(self) -> None:
        vox = Vox()
        vox.check(self.record)
        empty = bar(0, 0)
        for outcome in vox.simulate([bar(1, 3, 0), empty], self.record):
            samples = len(outcome.steps)
            canvas = (3, 1, 1) if samples else (2, 1, 1)
            shapes = {name: track.shape for name, track in outcome.tracks.items()}
            assert shapes == {
                "tip": (samples, 3),
                "voxels": (samples, *canvas, 3),
                "energy": (samples, 2),
                "strain": (samples, 2),
                "momentum": (samples, 6),
            }

    def test_the_last_voxel_is_the_tip(self) -> None:
        [outcome] = Vox().simulate([bar(1, 3, 3, 0)], self.record)
        assert (outcome.tracks["voxels"][:, 2, 0, 0] == outcome.tracks["tip"]).all()
        assert np.isnan(outcome.tracks["voxels"][:, 3]).all()

    def test_unknown_ones_are_refused_with_what_there_is(self) -> None:
        expected = "points: tip, face, body; further tracks: voxels, energy, strain, momentum$"
        with pytest.raises(ConfigurationError, match=f"no track 'voxel'; {expected}"):
            Vox().check(Record(("tip", "voxel")))

    def test_a_record_that_no_memory_holds_is_refused(self) -> None:
        vox = Vox(duration=20_000.0, step_limit=10**8)
        with pytest.raises(InputError, match=r"samples of voxels would take .* GiB for one body, at most 4"):
            vox.simulate([bar(*[1] * 200)], Record(("voxels",)))

    @pytest.mark.parametrize("record", [Record(("tip",)), Record(("tip",), every=0.01, samples=(0, 3))])
    def test_substeps_leave_the_instants_where_they_are(self, record: Record) -> None:
        [coarse], [fine] = (Vox(substeps=k).simulate([bar(1, 3, 3)], record) for k in (1, 5))
        assert (fine.steps == 5 * coarse.steps).all()
        assert fine.times == pytest.approx(coarse.times, rel=1e-14)
        assert 0 < np.abs(fine.tracks["tip"] - coarse.tracks["tip"]).max() < 0.02 * Vox().voxel_size
