"""Reading of VXA files: handwritten files for three programs, and rejected features."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import attrs
import numpy as np
import pytest
from processes import python

from evoframe import Design, FileOptions, InputError, Record
from evoframe.documents.structuring import structure
from evoframe_simulators import Vox
from evoframe_simulators.vox.vxa import read_vxa

EXAMPLES = Path(__file__).parents[4] / "data" / "vxa"

Write = Callable[..., Path]


def slab(x: int, canvas: tuple[int, int, int]) -> dict[str, Any]:
    """Return the center-to-center region that clamps all cells of one x."""
    return {
        "origin": [(x + 0.5) / canvas[0], *(0.5 / cells for cells in canvas[1:])],
        "size": [0.0, *((cells - 1) / cells for cells in canvas[1:])],
        "degrees_of_freedom": ["x", "y", "z", "rx", "ry", "rz"],
    }


def simulator(path: Path) -> Vox:
    """Return the simulator for a file, converted to TOML values and back."""
    settings = Vox.settings_of(path)
    assert settings is not None
    assert set(settings) == {field.name for field in attrs.fields(Vox)}
    return structure(json.loads(json.dumps(settings)), Vox, ("simulator",))


def changed(path: Path) -> dict[str, Any]:
    """Return the options of a file that differ from the paper's, except the palette."""
    settings, paper = Vox.settings_of(path), attrs.asdict(Vox())
    assert settings is not None
    return {name: value for name, value in settings.items() if value != paper[name] and name != "palette"}


class TestTemplate:
    path = EXAMPLES / "template.vxa"

    def test_has_the_settings_of_the_paper(self) -> None:
        assert changed(self.path) == {"fixed": [slab(0, (6, 3, 3))]}

    def test_has_the_materials_of_its_voxels(self) -> None:
        palette = simulator(self.path).palette
        assert [(material.code, material.name) for material in palette] == [
            (1, "Passive_Soft"),
            (3, "Active_+"),
        ]
        assert [material.expansion_coefficient for material in palette] == [0.0, 0.01]
        assert {material.youngs_modulus for material in palette} == {5e6}

    def test_has_a_body_with_offsets_in_cycles(self) -> None:
        [(label, design)] = Vox().read(self.path)
        assert label == "template.vxa"
        material, phase = design.roles["morphology"], design.roles["controller"]
        expected = np.ones((6, 3, 3), np.uint8)
        expected[2:4, 1, 1], expected[4, 1, 1] = 3, 0
        assert (material == expected).all()
        assert ((phase != 0) == (material == 3)).all()
        assert 1 < np.abs(phase[material == 3]).max() <= 2 * np.pi

    def test_simulates_like_the_paper(self) -> None:
        [(_, design)] = Vox().read(self.path)
        record = Record(("tip", "voxels"))
        [own], [paper] = (vox.simulate([design], record) for vox in (simulator(self.path), Vox()))
        assert (own.steps == paper.steps).all()
        assert (own.tracks["tip"] == paper.tracks["tip"]).all()

    def test_is_simulated_with_its_own_settings_by_the_program(self) -> None:
        finished = python("-m", "evoframe", "simulate", self.path, "--json", "--preset", "quick")
        [displacement] = json.loads(finished.stdout)["displacement"]
        [(_, design)] = Vox().read(self.path)
        [outcome] = Vox().simulate([design], Record(("tip",), every=0.01, samples=(0, 5)))
        assert displacement == outcome.tracks["tip"][1, 2] - outcome.tracks["tip"][0, 2]

    def test_offsets_are_read_in_radians_on_demand(self) -> None:
        [(_, design)] = Vox(phase_unit="radians").read(self.path)
        assert (design.roles["controller"] == Vox().read(self.path)[0][1].roles["controller"]).all()

    def test_a_material_that_the_simulator_lacks_is_rejected(self) -> None:
        vox = Vox(palette=simulator(self.path).palette[:1])
        with pytest.raises(InputError, match=r"code 3; .* 0 empty, 1 Passive_Soft$") as caught:
            vox.read(self.path)
        assert (caught.value.source, caught.value.key) == (str(self.path), "material")


class TestEvosoro:
    """A swimmer of evosoro, which the fork would pull down on a sloping floor."""

    path = EXAMPLES / "evosoro.vxa"

    def read(self, dialect: str) -> tuple[Vox, Design]:
        contents = Vox.interpret(self.path, FileOptions(dialect))
        assert contents is not None
        [(_, design)] = contents.designs
        return structure(json.loads(json.dumps(contents.settings)), Vox, ("simulator",)), design

    def test_has_its_settings(self) -> None:
        assert changed(self.path) == {
            "duration": 0.5,
            "voxel_size": 0.01,
            "time_step_fraction": 0.7,
            "start_time": 0.1,
            "largest_size": 10.0,
            "size_rule": "clamp",
            "fluid_drag": 750.0,
            "temperature_amplitude": 39.0,
            "frequency": 1 / 0.263662540539,
            "fixed": [],
        }

    def test_has_weight_and_floor_in_the_fork(self) -> None:
        fork, evosoro = self.read("fork")[0], self.read("evosoro")[0]
        assert attrs.evolve(fork, gravity=0.0, floor=False, floor_slope=0.0) == attrs.evolve(
            evosoro, largest_size=3.0, size_rule="hold"
        )
        assert (fork.gravity, fork.floor, fork.floor_slope) == (-9.81, True, 2.5)

    def test_walks_in_the_fork(self) -> None:
        vox, design = self.read("fork")
        assert [material.code for material in vox.palette] == [1, 2, 3, 4]
        [outcome] = vox.simulate([design], Record(("body",)))
        assert outcome.diverged_at is None
        assert np.ptp(outcome.tracks["body"], axis=0).min() > 1e-5
        [still] = attrs.evolve(vox, temperature_amplitude=25.0).simulate([design], Record(("body",)))
        onset = int(np.searchsorted(outcome.times, 0.1)) - 1
        assert (still.tracks["body"][:onset] == outcome.tracks["body"][:onset]).all()
        assert (still.tracks["body"][-1] != outcome.tracks["body"][-1]).any()

    def test_conserves_momentum_in_water_without_drag(self) -> None:
        vox, design = self.read("evosoro")
        free = attrs.evolve(vox, fluid_drag=0.0, slow_damping=0.0)
        record = Record(("momentum", "body", "voxels"), initial=True)
        [outcome] = free.simulate([design], record)
        moving = np.nanmax(np.abs(np.diff(outcome.tracks["voxels"], axis=0))) / outcome.times[1]
        mass = np.count_nonzero(design.roles["morphology"]) * 1e6 * vox.voxel_size**3
        assert moving > 0.01  # m/s
        assert np.abs(outcome.tracks["momentum"][:, :3]).max() < 1e-9 * mass * moving

    def test_swims_less_far_than_it_falls(self) -> None:
        travelled = {}
        for dialect in ("fork", "evosoro"):
            vox, design = self.read(dialect)
            [outcome] = vox.simulate([design], Record(("body",), initial=True))
            travelled[dialect] = float(np.linalg.norm(outcome.tracks["body"][-1] - outcome.tracks["body"][0]))
        assert travelled["evosoro"] < 0.2 * travelled["fork"]


class TestVoxcad:
    path = EXAMPLES / "voxcad.vxa"

    def test_has_the_defaults_of_the_engine_for_missing_tags(self) -> None:
        options = changed(self.path)
        assert options.pop("duration") > 0
        assert options == {
            "voxel_size": 0.001,
            "temperature_amplitude": 25.0,
            "gravity": -9.81,
            "slow_damping": 0.001,
            "collision_damping": 1.0,
            "self_collision": False,
            "fixed": [slab(0, (5, 1, 1)), slab(4, (5, 1, 1))],
        }
        [material] = simulator(self.path).palette
        assert (material.poisson_ratio, material.static_friction, material.dynamic_friction) == (0, 0, 0)

    def test_stops_one_step_after_the_given_number_like_the_engine(self) -> None:
        vox = simulator(self.path)
        [outcome] = vox.simulate([vox.read(self.path)[0][1]], Record(("tip",)))
        assert len(outcome.steps) == 20 + 1

    @pytest.mark.parametrize(("counted", "steps"), [("0", 1), ("7.4", 8), ("7.5", 9), ("100000", 100001)])
    def test_the_number_of_steps_is_rounded(self, vxa: Write, counted: str, steps: int) -> None:
        path = vxa("voxcad", StopConditionValue=counted)
        vox = simulator(path)
        [outcome] = vox.simulate([vox.read(path)[0][1]], Record(("tip",), every=1.0))
        assert vox.duration / outcome.times[0] == pytest.approx(steps - 0.5)


class TestSettings:
    """Options for the template with single tags changed."""

    @pytest.mark.parametrize(
        ("tags", "options"),
        [
            ({"GravEnabled": 1}, {"gravity": -9.81}),
            ({"GravEnabled": 1, "GravAcc": 3.7}, {"gravity": 3.7}),
            ({"FloorEnabled": 1, "FloorSlope": -5}, {"floor": True, "floor_slope": -5.0}),
            ({"FloorSlope": 30}, {}),
            ({"SelfColEnabled": 0, "ColSystem": 0, "CollisionHorizon": 0}, {"self_collision": False}),
            ({"ColSystem": 2, "CollisionHorizon": 3}, {"collision_horizon": 3.0}),
            ({"DtFrac": 0.5}, {"time_step_fraction": 0.5}),
            ({"InitCmTime": 0.02, "ActuationStartTime": 0.02}, {"start_time": 0.02}),
            ({"FluidEnvironment": 1, "AggregateDragCoefficient": 750}, {"fluid_drag": 750.0}),
            ({"AggregateDragCoefficient": 750}, {}),
            ({"TempEnabled": 0, "VaryTempEnabled": 0, "TempPeriod": 0}, {"temperature_amplitude": 25.0}),
            ({"TempAmp": 25, "VaryTempEnabled": 0}, {"temperature_amplitude": 25.0}),
            ({"TempBase": 20, "TempAmp": 30}, {"temperature_base": 20.0, "temperature_amplitude": 30.0}),
            ({"TempPeriod": 0.5}, {"frequency": 2.0}),
            ({"StopConditionType": 3, "StopConditionValue": 2}, {"duration": 0.5}),
            (
                {"StopConditionType": 3, "StopConditionValue": 2, "TempPeriod": 0.5, "TempEnabled": 0},
                {"duration": 1.0, "temperature_amplitude": 25.0},
            ),
            (
                {"BondDampingZ": 0.1, "ColDampingZ": 0, "SlowDampingZ": "1e-003"},
                {
                    "bond_damping": 0.1,
                    "collision_damping": 0.0,
                    "slow_damping": 0.001,
                },
            ),
        ],
    )
    def test_tags_set_options(self, vxa: Write, tags: dict[str, Any], options: dict[str, Any]) -> None:
        read = changed(vxa(**tags))
        read.pop("fixed")
        assert read == options

    def test_an_amplitude_is_added_to_the_base(self, vxa: Write) -> None:
        path = vxa(
            after={"<TempBase>25</TempBase>": "<TempAmplitude>14.4714242553</TempAmplitude>"}, TempAmp=0
        )
        vox = simulator(path)
        assert vox.temperature_amplitude - vox.temperature_base == pytest.approx(14.4714242553, rel=1e-15)

    def test_a_large_base_does_not_round_the_amplitude(self, vxa: Write) -> None:
        vox = simulator(
            vxa(
                after={"<TempAmp>39.4714242553</TempAmp>": "<TempAmplitude>1e-7</TempAmplitude>"},
                TempBase=1e12,
            )
        )
        assert vox.temperature_amplitude - vox.temperature_base == 1e-7

    @pytest.mark.parametrize(("bits", "held"), [(5, ["x", "z"]), (56, ["rx", "ry", "rz"]), (0, None)])
    def test_degrees_of_freedom_are_bits(self, vxa: Write, bits: int, held: list[str] | None) -> None:
        settings = Vox.settings_of(vxa(DofFixed=bits))
        assert settings is not None
        assert [region["degrees_of_freedom"] for region in settings["fixed"]] == ([held] if held else [])

    @pytest.mark.parametrize("section", ["Integration", "Collisions", "Features", "EquilibriumMode", "GA"])
    def test_optional_sections_may_be_missing(self, vxa: Write, section: str) -> None:
        read = changed(vxa(without=[section]))
        read.pop("fixed")
        assert read == ({"self_collision": False} if section == "Collisions" else {})

    def test_missing_offsets_are_0(self, vxa: Write) -> None:
        [(_, design)] = Vox().read(vxa(without=["PhaseOffset"]))
        assert not design.roles["controller"].any()

    @pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "iso-8859-1"])
    def test_names_may_have_accents_in_every_encoding(self, vxa: Write, encoding: str) -> None:
        path = vxa(Name="Größe é")
        path.write_bytes(path.read_text(encoding="utf-8").encode(encoding))
        assert simulator(path).palette[0].name == "Größe é"

    def test_materials_from_10_are_the_characters_after_the_digits(self, vxa: Write) -> None:
        path = vxa("voxcad")
        materials = "".join(
            f"<Material><Mechanical><Elastic_Mod>{n}e6</Elastic_Mod><Density>1e3</Density></Mechanical></Material>"
            for n in range(1, 21)
        )
        text = path.read_text().replace("11111", "19:C0").replace("</Palette>", f"{materials}</Palette>")
        path.write_text(text)
        vox = simulator(path)
        assert vox.read(path)[0][1].roles["morphology"].ravel().tolist() == [1, 9, 10, 19, 0]
        assert [material.youngs_modulus for material in vox.palette] == [1e7, 7e6, 8e6, 17e6]

    @pytest.mark.parametrize("code", [85, 112])
    def test_materials_encoded_as_unicode_whitespace_are_cells(self, vxa: Write, code: int) -> None:
        path = vxa("voxcad")
        mechanical = "<Mechanical><Elastic_Mod>1e7</Elastic_Mod><Density>1e3</Density></Mechanical>"
        palette, blank = "<Palette>" + 112 * f"<Material>{mechanical}</Material>", chr(48 + code)
        text = path.read_text().replace("<Palette>", palette).replace("11111", f"\n{blank}111{blank} ")
        path.write_text(text, encoding="utf-8")
        [(_, design)] = simulator(path).read(path)
        assert design.roles["morphology"].ravel().tolist() == [code, 1, 1, 1, code]

    def test_a_number_of_periods_has_single_precision(self, vxa: Write) -> None:
        path = vxa(StopConditionType=3, StopConditionValue=3, TempPeriod=0.1)
        assert simulator(path).duration == 3 * float(np.float32(0.1))

    @pytest.mark.parametrize(("value", "period"), [("1e300", "1e30"), ("2", "1e-60")])
    def test_periods_out_of_range_are_rejected(self, vxa: Write, value: str, period: str) -> None:
        path = vxa(StopConditionType=3, StopConditionValue=value, TempPeriod=period, TempEnabled=0)
        with pytest.raises(InputError) as caught:
            simulator(path)
        assert caught.value.source == str(path)

    @pytest.mark.parametrize(("value", "period"), [(0, 0.25), (2, 0), (-1, 0.25), (2, -0.1)])
    def test_a_duration_without_periods_is_rejected(self, vxa: Write, value: float, period: float) -> None:
        path = vxa(StopConditionType=3, StopConditionValue=value, TempPeriod=period, TempEnabled=0)
        with pytest.raises(InputError, match=r"above 0, found") as caught:
            simulator(path)
        assert caught.value.key == (
            "Simulator/StopCondition/StopConditionValue" if value <= 0 else "Environment/Thermal/TempPeriod"
        )

    def test_an_npz_file_has_no_settings(self, tmp_path: Path) -> None:
        assert Vox.settings_of(tmp_path / "no.npz") is None

    def test_another_file_name_extension_is_rejected(self, tmp_path: Path) -> None:
        assert Vox.settings_of(tmp_path / "a.stl") is None
        with pytest.raises(InputError, match=r"\.npz, .*\.vxa, .*\.vxc, .*\.vxd") as caught:
            Vox().read(tmp_path / "a.stl")
        assert caught.value.source == str(tmp_path / "a.stl")


class TestErrors:
    """Errors for features that vox lacks, with tag and value."""

    @pytest.mark.parametrize(
        ("tag", "value", "named"),
        [
            ("FluidDampEnabled", "1", "Simulator/Features/FluidDampEnabled = '1'"),
            ("EquilibriumModeEnabled", "1", "Simulator/EquilibriumMode/EquilibriumModeEnabled = '1'"),
            ("Integrator", "1", "Simulator/Integration/Integrator = '1'"),
            ("ColSystem", "0", "Simulator/Collisions/ColSystem = '0' (expected 3)"),
            ("StopConditionType", "4", "StopCondition/StopConditionType = '4' ("),
            ("ActuationStartTime", "0.1", "ActuationStartTime = '0.1' ("),
            ("ForceX", "3", "Environment/Boundary_Conditions/FRegion 1/ForceX = '3'"),
            ("TorqueZ", "-1", "FRegion 1/TorqueZ = '-1'"),
            ("DisplaceY", "1e-3", "FRegion 1/DisplaceY = '1e-3'"),
            ("AngDisplaceX", "1", "FRegion 1/AngDisplaceX = '1'"),
            ("PrimType", "1", "FRegion 1/PrimType = '1' (a cylinder"),
            ("PrimType", "2", "FRegion 1/PrimType = '2' (a sphere"),
            ("RegenerationModelUpdatesPerTempCycle", "4", "RegenerationModelUpdatesPerTempCycle = '4'"),
            ("ControllerUpdatesPerTempCycle", "4", "Controller/ControllerUpdatesPerTempCycle = '4'"),
            ("X_Dim_Adj", "0.5", "VXC/Lattice/X_Dim_Adj = '0.5'"),
            ("Y_Layer_Offset", "0.5", "VXC/Lattice/Y_Layer_Offset = '0.5'"),
            ("Z_Squeeze", "2", "VXC/Voxel/Z_Squeeze = '2'"),
            ("MatType", "1", "VXC/Palette/Material 1/MatType = '1'"),
            ("MatModel", "3", "VXC/Palette/Material 1/Mechanical/MatModel = '3'"),
            ("MatModel", "linear", "VXC/Palette/Material 1/Mechanical/MatModel = 'linear'"),
            ("numControllerSynapses", "18", "VXC/Structure/numControllerSynapses = '18'"),
        ],
    )
    def test_contain_tag_and_value(self, vxa: Write, tag: str, value: str, named: str) -> None:
        self.assert_only_this_is_named(vxa(**{tag: value}), named)

    @pytest.mark.parametrize(
        ("after", "more", "named"),
        [
            ("<Features>", "<VolumeEffectsEnabled>1</VolumeEffectsEnabled>", "VolumeEffectsEnabled = '1'"),
            ("<Features>", "<BlendingEnabled>1</BlendingEnabled>", "Features/BlendingEnabled = '1'"),
            ("<Features>", "<MaxVelLimitEnabled>1</MaxVelLimitEnabled>", "MaxVelLimitEnabled = '1'"),
            ("</GA>", "<ParentsWanted>2</ParentsWanted>", "ParentsWanted = '2' (unknown tag)"),
            ("<Environment>", "<FloorRadius>4</FloorRadius>", "Environment/FloorRadius = '4'"),
            ("<Environment>", "<Sources><Source/></Sources>", "Environment/Sources = ''"),
            ("<Environment>", "<Wind><A>0</A><B>3</B></Wind>", "Environment/Wind = '0 3' (unknown tag)"),
            ('<VXA Version="1.0">', "<Dream><Use>1</Use></Dream>", "Dream = '1' (unknown tag)"),
            ("</Data>", "<Stiffness><Layer>5, 5, </Layer></Stiffness>", "VXC/Structure/Stiffness = '5, 5,'"),
            ("</Data>", "<FinalPhaseOffset/>", "VXC/Structure/FinalPhaseOffset = ''"),
            ("</Data>", "<InitialVoxelSize/>", "VXC/Structure/InitialVoxelSize = ''"),
            (
                "<Environment>",
                "<Fixed_Regions><NumFixed>1</NumFixed><FRegion/></Fixed_Regions>",
                "Environment/Fixed_Regions = regions (",
            ),
        ],
    )
    def test_contain_tags_that_the_template_lacks(
        self, vxa: Write, after: str, more: str, named: str
    ) -> None:
        self.assert_only_this_is_named(vxa(after={after: more}), named)

    def assert_only_this_is_named(self, path: Path, named: str) -> None:
        with pytest.raises(InputError) as caught:
            Vox.settings_of(path)
        assert caught.value.source == str(path)
        kind, _, value = caught.value.problem.partition(": ")
        assert named in f"{caught.value.key} = {value}"
        assert "not simulated" in kind

    def test_report_all_tags_together(self, vxa: Write) -> None:
        path = vxa(Integrator=1, PrimType=2, MatModel=1, ColSystem=1, StopConditionType=6, TorqueX=1)
        with pytest.raises(InputError) as caught:
            read_vxa(path)
        named = ("Integrator", "PrimType", "MatModel", "ColSystem", "StopConditionType", "TorqueX")
        assert all(tag in str(caught.value) for tag in named)

    def test_are_reported_with_values_out_of_range(self, vxa: Write) -> None:
        path = vxa(PrimType=2, DtFrac=1.5, StopConditionType=6)
        with pytest.raises(InputError, match="3 faults") as caught:
            read_vxa(path)
        assert "DtFrac" in caught.value.problem
        with pytest.raises(InputError) as caught:
            read_vxa(path, given=["duration", "time_step_fraction"])
        assert "PrimType" in caught.value.key

    @pytest.mark.parametrize("compression", ["RAW_DATA", "GZIP", "zlib"])
    def test_contain_an_unknown_encoding_of_the_structure(self, vxa: Write, compression: str) -> None:
        path = vxa()
        path.write_text(path.read_text().replace('"ASCII_READABLE"', f'"{compression}"'))
        with pytest.raises(InputError, match=rf"'{compression}' \(.*ASCII_READABLE.*ZLIB") as caught:
            read_vxa(path)
        assert caught.value.key == "VXC/Structure Compression"

    def test_contain_another_version_of_the_structure(self, vxa: Write) -> None:
        path = vxa()
        path.write_text(path.read_text().replace('VXC Version="0.93"', 'VXC Version="0.92"'))
        with pytest.raises(InputError, match=r"'0\.92' \(.*0\.93 .* 0\.94\)") as caught:
            read_vxa(path)
        assert caught.value.key == "VXC Version"


def test_a_design_equals_the_contents_of_the_file() -> None:
    for name in ("template", "evosoro", "voxcad"):
        file = read_vxa(EXAMPLES / f"{name}.vxa")
        [(_, design)] = simulator(EXAMPLES / f"{name}.vxa").read(EXAMPLES / f"{name}.vxa")
        assert isinstance(design, Design)
        assert design.roles["morphology"].dtype == np.uint8
        assert (design.roles["morphology"] == file.material).all()
        assert (design.roles["controller"] == file.phase).all()
