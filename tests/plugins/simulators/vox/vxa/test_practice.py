"""Files in the manner of what people exchange: positions of the reference engine, and what each file says."""

from __future__ import annotations

import base64
import json
import shutil
import zlib
from collections.abc import Callable
from pathlib import Path
from subprocess import CompletedProcess
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from processes import python

from evoframe import Design, FileOptions, InputError, Record
from evoframe.documents.structuring import structure
from evoframe_simulators import Vox
from evoframe_simulators.vox.vxa import read_vxa

PRACTICE = Path(__file__).parents[4] / "data" / "vxa" / "practice"
EXPECTED: dict[str, dict[str, Any]] = json.loads((PRACTICE / "expected.json").read_text())

CLOSE = 1e-9  # m


def evoframe(*words: object) -> CompletedProcess[str]:
    """Run a command."""
    return python("-m", "evoframe", *words)


def opened(path: Path, **options: Any) -> tuple[Vox, Design, tuple[str, ...]]:
    """Return simulator, body and notes of a file, as the commands read it."""
    contents = Vox.interpret(path, FileOptions(**options))
    assert contents is not None
    [(_, design)] = contents.designs
    return structure(json.loads(json.dumps(contents.settings)), Vox, ("simulator",)), design, contents.notes


def final(vox: Vox, design: Design) -> tuple[int, NDArray[np.float64]]:
    """Return the number of steps, and the final positions of the voxels, x fastest."""
    [outcome] = vox.simulate([design], Record(("voxels",)))
    assert outcome.diverged_at is None
    positions = outcome.tracks["voxels"][-1].transpose(2, 1, 0, 3).reshape(-1, 3)
    return int(outcome.steps[-1]), positions[np.isfinite(positions).all(axis=1)]


def assert_agrees(vox: Vox, design: Design, name: str) -> None:
    steps, positions = final(vox, design)
    assert steps == EXPECTED[name]["steps"]
    expected = np.array(EXPECTED[name]["final_positions"])
    assert np.abs(positions - expected).max() < CLOSE


@pytest.mark.parametrize("name", EXPECTED)
def test_positions_agree_with_the_reference_engine(name: str) -> None:
    vox, design, _ = opened(PRACTICE / name)
    assert_agrees(vox, design, name)


class TestEncodings:
    @pytest.mark.parametrize("name", ["walker_base64", "walker_long", "walker_utf16"])
    def test_of_the_same_body_make_no_difference(self, name: str) -> None:
        one, design, _ = opened(PRACTICE / "walker_ascii.vxa")
        other, same, _ = opened(PRACTICE / f"{name}.vxa")
        assert one == other
        assert all((array == same.roles[role]).all() for role, array in design.roles.items())

    @pytest.mark.parametrize(("compression", "head"), [("ZLIB", b""), ("QT_ZLIB", bytes(3) + b"\x06")])
    def test_by_zlib_are_read(self, compression: str, head: bytes, tmp_path: Path) -> None:
        text = (PRACTICE / "walker_ascii.vxa").read_text().replace("ASCII_READABLE", compression)
        for layer in ("120213", "123321", "102030"):
            data = head + zlib.compress(bytes(int(cell) for cell in layer))
            text = text.replace(layer, base64.b64encode(data).decode())
        path = tmp_path / "a.vxa"
        path.write_text(text)
        vox, design, _ = opened(path)
        assert_agrees(vox, design, "walker_ascii.vxa")


class TestEnd:
    """Files that do not say when their simulation ends."""

    @pytest.fixture(params=["type 0", "no tag", "no section"])
    def endless(self, request: pytest.FixtureRequest, tmp_path: Path) -> Path:
        text = (PRACTICE / "walker_stop0.vxa").read_text()
        start, end = text.index("<StopCondition>"), text.index("</StopCondition>") + len("</StopCondition>")
        inner = {"type 0": text[start:end], "no tag": "<StopCondition/>", "no section": ""}[request.param]
        path = tmp_path / "endless.vxa"
        path.write_text(text[:start] + inner + text[end:])
        return path

    def test_is_the_only_thing_missing(self, endless: Path) -> None:
        with pytest.raises(InputError) as caught:
            opened(endless)
        assert (caught.value.source, caught.value.key) == (str(endless), "Simulator/StopCondition")

    def test_can_be_set(self, endless: Path) -> None:
        vox, design, _ = opened(endless, settings={"duration": 0.2})
        assert_agrees(vox, design, "walker_ascii.vxa")

    def test_is_not_taken_from_the_preset(self, endless: Path) -> None:
        refused = evoframe("simulate", endless, "--preset", "locomotion")
        assert refused.returncode == 2
        assert f"{endless}: Simulator/StopCondition: " in refused.stderr

    def test_can_be_set_for_the_program(self, endless: Path) -> None:
        [one], [other] = (
            json.loads(evoframe("simulate", path, "--json", *options).stdout)["score"]
            for path, options in (
                (endless, ["--set", "simulator.duration=0.2"]),
                (PRACTICE / "walker_ascii.vxa", []),
            )
        )
        assert one == other


def test_a_fault_is_named_by_its_tag_and_can_be_overridden() -> None:
    with pytest.raises(InputError) as caught:
        opened(PRACTICE / "v_dt15.vxa")
    assert caught.value.key == "Simulator/Integration/DtFrac"
    vox, design, _ = opened(PRACTICE / "v_dt15.vxa", settings={"time_step_fraction": 0.9})
    assert_agrees(vox, design, "walker_ascii.vxa")


def test_offsets_without_commas_are_explained() -> None:
    with pytest.raises(InputError, match="commas") as caught:
        opened(PRACTICE / "walker_phase_blank.vxa")
    assert caught.value.key == "VXC/Structure/PhaseOffset/Layer 1"


class TestBodyAlone:
    path = PRACTICE / "walker.vxc"

    def test_brings_its_palette_and_edge(self) -> None:
        contents = Vox.interpret(self.path, FileOptions())
        assert contents is not None
        assert set(contents.settings) == {"voxel_size", "palette"}
        assert contents.settings["voxel_size"] == 0.01
        assert [each["expansion_coefficient"] for each in contents.settings["palette"]] == [0.0, 0.01, -0.01]
        [note] = contents.notes
        assert "preset" in note

    def test_may_take_its_settings_from_a_file(self) -> None:
        vox, design, _ = opened(self.path, base=PRACTICE / "walker_ascii.vxa")
        assert_agrees(vox, design, "walker_ascii.vxa")

    def test_is_simulated_with_the_settings_of_the_preset(self) -> None:
        finished = evoframe("simulate", self.path, "--preset", "locomotion", "--json")
        assert json.loads(finished.stdout)["objective"] == ["travel"]
        assert str(self.path) in finished.stderr


class TestCompletion:
    """A VXD file, which completes a base."""

    path = PRACTICE / "walker.vxd"

    def test_by_a_named_base(self) -> None:
        vox, design, notes = opened(self.path, base=PRACTICE / "walker_ascii.vxa")
        assert_agrees(vox, design, "walker_ascii.vxa")
        assert any("walker_ascii.vxa" in note for note in notes)

    @pytest.mark.parametrize("names", [["base.vxa"], ["base.vxa", "other.vxa"], ["only.VXA"]])
    def test_by_a_file_beside_it(self, names: list[str], tmp_path: Path) -> None:
        path = Path(shutil.copy(self.path, tmp_path))
        for name in names:
            shutil.copyfile(PRACTICE / "walker_ascii.vxa", tmp_path / name)
        vox, design, _ = opened(path)
        assert_agrees(vox, design, "walker_ascii.vxa")

    @pytest.mark.parametrize("names", [[], ["a.vxa", "b.vxa"]])
    def test_without_a_base_names_the_option(self, names: list[str], tmp_path: Path) -> None:
        path = Path(shutil.copy(self.path, tmp_path))
        for name in names:
            shutil.copyfile(PRACTICE / "walker_ascii.vxa", tmp_path / name)
        with pytest.raises(InputError, match=f"{len(names) or 'no'} VXA files? .* --base$") as caught:
            opened(path)
        assert caught.value.source == str(path)

    def test_by_the_program(self, tmp_path: Path) -> None:
        traced = evoframe(
            "simulate", self.path, "--base", PRACTICE / "walker_ascii.vxa", "--trace", tmp_path / "a.csv"
        )
        assert traced.returncode == 0
        last = (tmp_path / "a.csv").read_text().splitlines()[-1].split(",")
        assert int(last[0]) == EXPECTED["walker_ascii.vxa"]["steps"]
        assert np.allclose(
            [float(each) for each in last[-3:]], EXPECTED["walker_ascii.vxa"]["centre"], 0, CLOSE
        )


class TestTasks:
    """Tags of the paper's authors."""

    @pytest.fixture
    def tagged(self, tmp_path: Path) -> Callable[..., Path]:
        def write(*tags: str, name: str = "walker_ascii") -> Path:
            text = (PRACTICE / f"{name}.vxa").read_text()
            path = tmp_path / f"{name}.vxa"
            path.write_text(text.replace("</Environment>", f"{''.join(tags)}</Environment>"))
            return path

        return write

    @pytest.mark.parametrize(
        ("tag", "options"),
        [
            ("ContractOnly", {"largest_size": 1.0, "smallest_size": 0.1}),
            ("ExpandOnly", {"largest_size": 3.0, "smallest_size": 1.0}),
            ("FallingProhibited", {"falling_code": 7}),
        ],
    )
    def test_set_options(self, tagged: Callable[..., Path], tag: str, options: dict[str, Any]) -> None:
        settings = read_vxa(tagged(f"<{tag}>1</{tag}>")).settings()
        assert {name: getattr(settings, name) for name in options} == options
        assert settings.size_rule == "hold"

    def test_falling_ends_only_a_simulation_of_a_given_time(self, tagged: Callable[..., Path]) -> None:
        path = tagged("<FallingProhibited>1</FallingProhibited>")
        text = path.read_text()
        path.write_text(text.replace("<StopConditionType>2<", "<StopConditionType>3<"))
        assert read_vxa(path).settings().falling_code == 0

    def test_expansion_is_limited(self, tagged: Callable[..., Path]) -> None:
        positions = {
            tag: final(*opened(tagged(f"<{tag}>1</{tag}>"))[:2])[1] for tag in ("ContractOnly", "ExpandOnly")
        }
        assert np.abs(positions["ContractOnly"] - positions["ExpandOnly"]).max() > 1e-4
