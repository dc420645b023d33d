"""Writing of VXA files: all sections, and the same simulation bit for bit after reading."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any

import attrs
import numpy as np
import pytest
from bars import soft
from hypothesis import given, settings, strategies as st
from lxml import etree

from evoframe import ConfigurationError, Design, InputError, Record
from evoframe.documents.structuring import structure
from evoframe.testing.laws import same_outcome
from evoframe_simulators import FixedRegion, PaletteMaterial, Vox
from evoframe_simulators.vox.regions import DEGREES_OF_FREEDOM
from evoframe_simulators.vox.vxa.schema import VXA, Role, Schema

TRACKS = Record(("tip", "face", "body", "voxels", "energy", "strain", "momentum"), initial=True)


OLDER = ("Environment/Fixed_Regions", "Environment/Forced_Regions")
"""Sections that only older files have."""

VOXCRAFT = (
    *(f"Simulator/{tag}" for tag in ("AttachDetach", "EnableCilia", "EnableSignals")),
    *(f"Simulator/{tag}" for tag in ("SecondaryExperiment", "SelfReplication")),
    *(f"VXC/Palette/Material/Mechanical/{tag}" for tag in ("Fixed", "LockZ", "sticky")),
)
"""Tags that only files of voxcraft have."""


def read(path: Path) -> tuple[Vox, Design]:
    vox = structure(Vox.settings_of(path), Vox, ("simulator",))
    [(_, design)] = vox.read(path)
    return vox, design


def written(vox: Vox, design: Design, path: Path) -> tuple[str, ...]:
    export = vox.export(design, "vxa")
    path.write_bytes(export.data)
    return export.left_out


def body(
    canvas: tuple[int, int, int] = (3, 2, 2), codes: tuple[int, ...] = (0, 1, 3), seed: int = 0
) -> Design:
    random = np.random.default_rng(seed)
    material = random.choice(np.array(codes, np.uint8), canvas)
    material[0] = codes[-1]
    return Design({"morphology": material, "controller": random.uniform(-7, 7, canvas)})


sizes = st.floats(1e-3, 1.0)
ratios = st.floats(0.0, 2.0)
flags = st.booleans()

materials = st.builds(
    PaletteMaterial,
    code=st.integers(1, 44),
    youngs_modulus=st.floats(1e5, 1e8),
    poisson_ratio=st.floats(0.0, 0.499),
    density=st.floats(1e2, 1e6),
    expansion_coefficient=st.just(0.0) | st.floats(-0.02, 0.02),
    static_friction=ratios,
    dynamic_friction=ratios,
    name=st.text(st.characters(categories=["L", "P", "S"], include_characters=" "), max_size=5),
)
regions = st.builds(
    FixedRegion,
    origin=st.tuples(*[st.floats(-1, 1)] * 3),
    size=st.tuples(*[st.floats(0, 2)] * 3),
    degrees_of_freedom=st.sets(st.sampled_from(DEGREES_OF_FREEDOM)).map(tuple),
)
options = st.fixed_dictionaries(
    {},
    optional={
        "palette": st.lists(materials, min_size=1, max_size=4, unique_by=lambda m: m.code).map(tuple),
        "voxel_size": sizes,
        "temperature_base": st.floats(-100, 100),
        "temperature_amplitude": st.floats(-100, 100),
        "frequency": st.floats(1e-3, 1e3),
        "phase_unit": st.sampled_from(["cycles", "radians"]),
        "start_time": st.floats(0, 0.02),
        "gravity": st.floats(-20, 20),
        "floor": flags,
        "floor_slope": st.floats(-45, 45),
        "fluid_drag": st.just(0.0) | st.floats(0, 1e4),
        "fixed": st.lists(regions, max_size=2).map(tuple),
        "self_collision": flags,
        "collision_horizon": st.floats(1, 4),
        "time_step_fraction": st.floats(0.1, 1),
        "bond_damping": ratios,
        "slow_damping": st.floats(0, 0.1),
        "collision_damping": ratios,
    },
)


def settled(given: dict[str, Any]) -> Vox:
    """Return a simulator whose duration is about thirty time steps."""
    vox = Vox(**given, duration=1e-9)
    [outcome] = vox.simulate([bar(vox)], Record(("tip",)))
    return attrs.evolve(vox, duration=30 * float(outcome.times[0]))


def bar(vox: Vox) -> Design:
    code = vox.palette[0].code if vox.palette else 1
    return Design({"morphology": np.full((2, 1, 1), code, np.uint8), "controller": np.zeros((2, 1, 1))})


@given(given=options, canvas=st.tuples(*[st.integers(1, 3)] * 3), seed=st.integers(0, 99))
@settings(max_examples=150)
def test_a_file_that_is_read_again_simulates_the_same_bit_for_bit(
    given: dict[str, Any], canvas: tuple[int, int, int], seed: int, tmp_path_factory: pytest.TempPathFactory
) -> None:
    vox = settled(given)
    codes = tuple(material.code for material in vox.palette) or (1, 3)
    design = body(canvas, (0, *codes), seed)
    path = tmp_path_factory.getbasetemp() / "again.vxa"
    assert written(vox, design, path) == ()
    again, same = read(path)
    assert (same.roles["morphology"] == design.roles["morphology"]).all()
    [one], [other] = vox.simulate([design], TRACKS), again.simulate([same], TRACKS)
    assert same_outcome(one, other)


class TestLeftOut:
    def test_is_empty_for_the_paper(self) -> None:
        assert Vox().export(body(), "vxa").left_out == ()

    @pytest.mark.parametrize(
        ("option", "value", "named"),
        [
            ("ramp", 0.5, "ramp = 0.5"),
            ("substeps", 2, "substeps = 2"),
            ("collision_envelope", 1.0, "collision_envelope = 1.0"),
            ("contact_damping", 0.1, "contact_damping = 0.1"),
            ("contact_friction", True, "contact_friction = True"),
            ("complete_contacts", True, "complete_contacts = True"),
            ("step_limit", 1000, "step_limit = 1000"),
            ("largest_strain", 2.0, "largest_strain = 2.0"),
            ("largest_distance", 2.0, "largest_distance = 2.0"),
            ("falling_code", 3, "falling_code = 3"),
        ],
    )
    def test_names_options_without_a_tag(self, option: str, value: Any, named: str) -> None:
        changed: dict[str, Any] = {option: value}
        [left_out] = Vox(**changed).export(body(), "vxa").left_out
        assert left_out.endswith(f"({named})")

    @pytest.mark.parametrize(
        ("options", "named"),
        [
            ({"largest_size": 1.1}, ["largest_size"]),
            ({"largest_size": 1.2}, []),
            ({"largest_size": 5.0}, []),
            ({"largest_size": 5.0, "expansion_coefficient": 0.2}, ["largest_size"]),
            ({"largest_size": 1.0}, []),
            ({"largest_size": 1.0, "size_rule": "clamp"}, ["size_rule"]),
            ({"smallest_size": 0.9, "size_rule": "clamp"}, ["size_rule"]),
            ({"smallest_size": 0.8, "size_rule": "clamp"}, []),
            ({"fluid_drag": 1.0, "fluid_surface": "voxel-size"}, ["fluid_surface"]),
            ({"fluid_surface": "voxel-size"}, []),
        ],
    )
    def test_names_sizes_and_fluid_if_they_have_an_effect(
        self, options: dict[str, Any], named: list[str]
    ) -> None:
        left_out = Vox(**options).export(body(), "vxa").left_out
        assert [re.findall(r"\((\w+) = ", each)[0] for each in left_out] == named

    def test_omits_options_of_contacts_without_contacts(self) -> None:
        vox = Vox(self_collision=False, collision_envelope=1.0, contact_damping=0.1, contact_friction=True)
        assert vox.export(body(), "vxa").left_out == ()

    def test_is_nothing_that_is_no_part_of_the_experiment(self) -> None:
        export, whole = (Vox(whole_body=value).export(body(), "vxa") for value in (False, True))
        assert whole == export

    def test_every_option_is_written_or_named(self) -> None:
        elsewhere = {
            *("duration", "voxel_size", "palette", "temperature_base", "temperature_amplitude", "frequency"),
            *("phase_unit", "start_time", "gravity", "floor", "floor_slope", "fluid_drag", "fixed"),
            *("self_collision", "collision_horizon", "time_step_fraction", "bond_damping", "slow_damping"),
            *("collision_damping", "youngs_modulus", "poisson_ratio", "density", "expansion_coefficient"),
            *("static_friction", "dynamic_friction", "smallest_size", "largest_size", "size_rule"),
            *("fluid_surface", "whole_body"),
        }
        named = {case[0] for case in _cases(TestLeftOut.test_names_options_without_a_tag)}
        assert named | elsewhere == {field.name for field in attrs.fields(Vox)}
        assert not named & elsewhere


def _cases(test: Any) -> list[tuple[Any, ...]]:
    [mark] = [mark for mark in test.pytestmark if mark.name == "parametrize"]
    return list(mark.args[1])


class TestFile:
    @pytest.fixture
    def root(self) -> etree._Element:
        return etree.fromstring(Vox(gravity=-9.81, floor=True).export(body(), "vxa").data)

    def test_the_same_arguments_give_the_same_bytes(self) -> None:
        assert Vox().export(body(), "vxa").data == Vox().export(body(), "vxa").data

    def test_no_text_element_is_empty(self, root: etree._Element) -> None:
        empty = {
            element.tag for element in root.iter() if not len(element) and not (element.text or "").strip()
        }
        assert empty == {"Vertices", "Facets", "Lines"}  # of an empty mesh, as written by the authors

    def test_every_section_that_the_engine_reads_exists(self, root: etree._Element) -> None:
        sections = {place for place in _sections(VXA) if not place.startswith((*OLDER, *VOXCRAFT))}
        there = {root.getroottree().getelementpath(element) for element in root.iter() if len(element)}
        assert sections - {re.sub(r"\[\d+\]", "", place) for place in there} == set()

    def test_disabled_features_have_their_tag_and_value(self, root: etree._Element) -> None:
        for place, value in _values(VXA):
            found = root.findall(place)
            assert all(float(element.text or "") == value for element in found)
            if not place.endswith(("PlasticityEnabled", "FailureEnabled")) and not place.startswith(VOXCRAFT):
                assert found, place

    @pytest.mark.parametrize(
        "options",
        [
            {"largest_size": 1.0},
            {"smallest_size": 1.0},
            {"smallest_size": 0.9},
            {"falling_code": 7},
            {"largest_size": 1.0, "smallest_size": 0.5, "falling_code": 7},
        ],
    )
    def test_limits_of_sizes_and_falling_are_read_again(
        self, options: dict[str, Any], tmp_path: Path
    ) -> None:
        vox = Vox(**options)
        assert written(vox, body(), tmp_path / "a.vxa") == ()
        again, _ = read(tmp_path / "a.vxa")
        assert {name: getattr(again, name) for name in options} == options

    def test_numbers_have_all_their_digits(self) -> None:
        size = math.nextafter(0.1, 1)
        text = Vox(voxel_size=size).export(body(), "vxa").data.decode()
        assert f"<Lattice_Dim>{size!r}</Lattice_Dim>" in text

    @pytest.mark.parametrize(("duration", "between"), [(0.07, "0.01"), (1.0, "0.01"), (50.0, "0.5")])
    def test_traces_of_long_simulations_are_sparse(self, duration: float, between: str) -> None:
        root = etree.fromstring(Vox(duration=duration).export(body(), "vxa").data)
        assert root.findtext("Environment/TimeBetweenTraces") == between

    def test_positions_in_the_palette_are_codes(self) -> None:
        root = etree.fromstring(Vox().export(body(), "vxa").data)
        names = [element.text for element in root.findall("VXC/Palette/Material/Name")]
        assert names == ["passive", "unused", "contractile"]
        assert [element.get("ID") for element in root.findall("VXC/Palette/Material")] == ["1", "2", "3"]

    def test_offsets_without_effect_may_have_any_value(self, tmp_path: Path) -> None:
        design = body()
        phase = np.where(design.roles["morphology"] == 3, design.roles["controller"], np.nan)
        written(Vox(), design.with_role("controller", phase), tmp_path / "a.vxa")
        _, again = read(tmp_path / "a.vxa")
        acting = design.roles["morphology"] == 3
        assert (again.roles["controller"] == np.where(acting, phase, 0.0)).all()

    def test_radians_are_written_as_cycles(self) -> None:
        cycles = body().with_role("controller", body().roles["controller"] / math.tau)
        assert Vox(phase_unit="radians").export(body(), "vxa") == Vox().export(cycles, "vxa")

    @pytest.mark.parametrize(
        "name",
        ["", "  ", "<&>", "größer", "\N{LATIN CAPITAL LETTER A WITH TILDE}\N{COPYRIGHT SIGN}", "\N{SNOWMAN}"],
    )
    def test_names_are_preserved(self, name: str, tmp_path: Path) -> None:
        material = attrs.evolve(soft(1), name=name)
        path = tmp_path / "a.vxa"
        design = Design({"morphology": np.ones((2, 1, 1), np.uint8), "controller": np.zeros((2, 1, 1))})
        written(Vox(palette=(material,)), design, path)
        assert read(path)[0].palette[0].name == (name.strip() or "material 1")


class TestErrors:
    def test_another_format(self) -> None:
        with pytest.raises(ConfigurationError, match=r"'stl'; .* vxa, npz$"):
            Vox().export(body(), "stl")

    @pytest.mark.parametrize(
        ("morphology", "phase", "key", "problem"),
        [
            (np.ones((2, 2), np.uint8), None, "morphology", r"uint8\[2, 2\]"),
            (np.full((2, 1, 1), 7, np.uint8), None, "material", "code 7; .* 0 empty, 1 passive"),
            (np.zeros((2, 1, 1), np.uint8), None, "morphology", "no voxels"),
            (np.full((2, 1, 1), 3, np.uint8), np.nan, "controller", "finite"),
            (np.full((2, 1, 1), 3, np.uint8), 1e7, "controller", r" 1e\+07 .* 1e\+06"),
        ],
    )
    def test_an_invalid_design(self, morphology: Any, phase: float | None, key: str, problem: str) -> None:
        design = Design({"morphology": morphology, "controller": np.full(morphology.shape, phase or 0.0)})
        with pytest.raises(InputError, match=problem) as caught:
            Vox().export(design, "vxa")
        assert caught.value.key == key

    def test_a_material_without_a_character(self) -> None:
        vox = Vox(palette=(soft(78), soft(79)))
        design = Design({"morphology": np.full((2, 1, 1), 78, np.uint8), "controller": np.zeros((2, 1, 1))})
        assert vox.export(design, "vxa").data
        with pytest.raises(InputError, match=r"material 79, .* 78 "):
            vox.export(design.with_role("morphology", np.full((2, 1, 1), 79, np.uint8)), "vxa")

    def test_materials_that_terminate_their_text(self) -> None:
        vox = Vox(palette=(soft(45), soft(14)))
        material = np.array([45, 45, 14], np.uint8).reshape(3, 1, 1)
        with pytest.raises(InputError, match="materials 45, 45, 14 "):
            vox.export(Design({"morphology": material, "controller": np.zeros((3, 1, 1))}), "vxa")
        upright = material.reshape(1, 1, 3)
        assert vox.export(Design({"morphology": upright, "controller": np.zeros((1, 1, 3))}), "vxa").data


def _sections(schema: Schema, place: str = "") -> list[str]:
    """Return the paths of all sections."""
    found = []
    for tag, role in schema.items():
        if not isinstance(role, Role | float):
            found += [f"{place}{tag}", *_sections(role, f"{place}{tag}/")]
    return found


def _values(schema: Schema, place: str = "") -> list[tuple[str, float]]:
    """Return the paths of tags with only one accepted value."""
    found: list[tuple[str, float]] = []
    for tag, role in schema.items():
        if isinstance(role, float):
            found.append((f"{place}{tag}", role))
        elif not isinstance(role, Role) and not tag.endswith("_Regions"):
            found += _values(role, f"{place}{tag}/")
    return found
