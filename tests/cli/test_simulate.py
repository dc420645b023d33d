"""``evoframe simulate``."""

from __future__ import annotations

import csv
import functools
import json
import math
import re
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any
from unittest.mock import ANY

import numpy as np
import pytest
import toys
from processes import Evoframe

from evoframe.messages import quantity

DATA = Path(__file__).parents[1] / "data"
GOLDEN = DATA / "paper_preset.npz"
WALKER = DATA / "measures" / "walker.vxa"


@pytest.fixture(scope="module")
def golden() -> dict[str, Any]:
    with np.load(GOLDEN) as arrays:
        return dict(arrays)


@pytest.fixture
def one_body(golden: dict[str, Any], tmp_path: Path) -> Path:
    path = tmp_path / "body.npz"
    np.savez(path, material=golden["material"][3], phase_cycles=golden["phase_cycles"][3])
    return path


def test_agrees_with_the_reference(evoframe: Evoframe, golden: dict[str, Any]) -> None:
    result = json.loads(evoframe("simulate", GOLDEN, "--json").stdout)
    assert result["diverged"] == [False] * 36
    assert np.abs(np.array(result["displacement"]) - golden["displacement"]).max() < 1e-9


def test_without_json_prints_a_row_for_each_body(evoframe: Evoframe, one_body: Path) -> None:
    exact = json.loads(evoframe("simulate", one_body, "--json").stdout)["displacement"][0]
    printed = evoframe("simulate", one_body, GOLDEN, "--workers", 2).stdout
    assert [line.split()[0] for line in printed.splitlines()[1:3]] == ["body.npz", "paper_preset.npz[0]"]
    assert quantity(exact, "m") in printed


def test_settings_can_be_changed(evoframe: Evoframe, golden: dict[str, Any], tmp_path: Path) -> None:
    path = tmp_path / "published.npz"
    np.savez(path, material=golden["material"][[0, 3, 6]], phase_cycles=golden["phase_cycles"][[0, 3, 6]])
    still = evoframe("simulate", path, "--json", "--set", "simulator.expansion_coefficient=0")
    displacement = json.loads(still.stdout)["displacement"]
    assert displacement == pytest.approx([0.0011106, 0.0019527, 0.0020189], abs=5e-8)


def test_a_trace_has_a_row_for_each_step(
    evoframe: Evoframe, golden: dict[str, Any], one_body: Path, tmp_path: Path
) -> None:
    trace = tmp_path / "trace.csv"
    assert evoframe("simulate", one_body, "--trace", trace).returncode == 0
    with trace.open() as file:
        rows = list(csv.DictReader(file))
    assert ",".join(rows[0]) == "step,time,tip_x,tip_y,tip_z,face_x,face_y,face_z,body_x,body_y,body_z"
    assert [int(row["step"]) for row in rows] == list(range(23))
    times = np.array([float(row["time"]) for row in rows])
    tip = np.array([[float(row[f"tip_{axis}"]) for axis in "xyz"] for row in rows])
    face = np.array([[float(row[f"face_{axis}"]) for axis in "xyz"] for row in rows])
    assert np.abs(times - golden["time"]).max() < 1e-12
    assert np.abs(tip - golden["tip"][3]).max() < 1e-9
    assert np.abs(face - golden["free_face_mean"][3]).max() < 1e-9


WITH_ENERGY = """
import attrs, numpy, toys
from evoframe import hookimpl

@attrs.frozen
class Warm(toys.Varied):
    tracks = ("value", "energy", "other")

    def simulate(self, designs, record):
        outcomes = super().simulate(designs, record)
        more = {"energy": numpy.zeros((1, 2)), "other": numpy.ones((1, 3))}
        return [attrs.evolve(outcome, tracks={**outcome.tracks, **more}) for outcome in outcomes]

@hookimpl
def evoframe_simulators():
    return {"warm": Warm}
"""


def test_a_trace_has_only_points(evoframe: Evoframe, tmp_path: Path) -> None:
    (tmp_path / "warm.py").write_text(WITH_ENERGY)
    (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
    (tmp_path / "one.toy").write_text("designs = [{ a = 2.0 }]\n")
    traced = evoframe(
        *("simulate", "-p", toys.__file__, "-p", "warm.py", "one.toy", "--preset", "toy.toml"),
        *("--set", "simulator=warm", "--trace", "trace.csv"),
        PYTHONPATH=str(Path(toys.__file__).parent),
    )
    assert traced.returncode == 0, traced.stderr
    assert (tmp_path / "trace.csv").read_text().splitlines() == [
        "step,time,value_x,value_y,value_z,other_x,other_y,other_z",
        "1,1.0,2.0,2.0,2.0,1.0,1.0,1.0",
    ]


class TestFileWithItsOwnSettings:
    """A toy's; those of ``vxa`` are in ``test_export.py``."""

    @pytest.fixture
    def simulate(self, evoframe: Evoframe, tmp_path: Path) -> Evoframe:
        (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
        path = tmp_path / "one.toy"
        path.write_text("designs = [{ a = 2.0 }]\nsettings = { gain = 4.0 }\n")
        command = ["simulate", "-p", toys.__file__, path, "--preset", "toy.toml"]
        return functools.partial(evoframe, *command, "--set", "simulator=toy-varied")

    def test_is_simulated_with_them(self, simulate: Evoframe) -> None:
        assert json.loads(simulate("--json").stdout)["score"] == [8.0]

    def test_is_simulated_with_what_is_set_all_the_same(self, simulate: Evoframe) -> None:
        result = json.loads(simulate("--json", "--set", "simulator.gain=3").stdout)
        assert result["score"] == [6.0]

    def test_is_named_when_one_of_them_is_wrong(self, simulate: Evoframe, tmp_path: Path) -> None:
        path = tmp_path / "one.toy"
        path.write_text("designs = [{ a = 2.0 }]\nsettings = { gian = 4.0 }\n")
        refused = simulate()
        assert refused.returncode == 2
        assert f"{path}: simulator.gian: " in refused.stderr
        assert "'gain'" in refused.stderr


class TestMeasure:
    """What a file is scored by, and what is said about it."""

    @pytest.fixture
    def short(self, evoframe: Evoframe, one_body: Path) -> Path:
        """A clamped body that ends before the paper's last sample, with its own settings."""
        made = evoframe("export", one_body, "--to", "vxa", "--set", "simulator.duration=0.02")
        assert made.returncode == 0, made.stderr
        return one_body.with_suffix(".vxa")

    def test_of_a_free_body_is_its_travel(self, evoframe: Evoframe) -> None:
        result = json.loads(evoframe("simulate", WALKER, "--json").stdout)
        assert (result["objective"], result["unit"], result["missing"]) == (["travel"], ["m"], [None])
        assert result["score"] == [pytest.approx(3.827e-3, abs=5e-7)]
        assert result["first_time"] == [pytest.approx(0.3, abs=5e-4)]
        assert result["last_time"] == [pytest.approx(2.00028424, abs=1e-8)]  # the last step

    def test_of_a_clamped_body_is_the_displacement_of_its_face(self, evoframe: Evoframe, short: Path) -> None:
        simulated = evoframe("simulate", short, "--json", "--trace", "trace.csv")
        assert simulated.returncode == 0, simulated.stderr
        with (short.parent / "trace.csv").open() as file:
            _, first, *_, last = csv.DictReader(file)
        y, z = (float(last[f"face_{axis}"]) - float(first[f"face_{axis}"]) for axis in "yz")
        result = json.loads(simulated.stdout)
        assert result["objective"] == ["face-yz"]
        assert result["score"] == [math.hypot(y, z)]
        assert [result["first_time"], result["last_time"]] == [[float(first["time"])], [float(last["time"])]]

    def test_is_named_with_its_times(self, evoframe: Evoframe) -> None:
        header, row = evoframe("simulate", WALKER).stdout.splitlines()
        assert re.split(r"\s{2,}", header.strip()) == ["design", "score", "objective", "measured"]
        assert re.split(r"\s{2,}", row.strip()) == ["walker.vxa", "3.827 mm", "travel", "0.3 s to 2 s"]

    def test_that_a_preset_brings_is_used_if_the_preset_is_given(self, evoframe: Evoframe) -> None:
        result = json.loads(evoframe("simulate", WALKER, "--preset", "paper", "--json").stdout)
        assert result["objective"] == ["tip-dz"]
        assert result["last_time"][0] < 0.07

    def test_that_looks_at_less_than_is_simulated_is_warned_of(
        self, evoframe: Evoframe, one_body: Path
    ) -> None:
        longer = ("--set", "simulator.duration=0.25")
        warned = evoframe("simulate", one_body, *longer)
        assert warned.returncode == 0
        assert warned.stderr.startswith("Warning: ")
        assert warned.stderr.endswith("looks at the first 0.067 s of 0.25 s\n")
        assert evoframe("-q", "simulate", one_body, *longer).stderr == ""
        assert evoframe("simulate", one_body, *longer, "--set", "objective.last=-1").stderr == ""
        assert evoframe("simulate", one_body).stderr == ""
        assert evoframe("simulate", WALKER).stderr == ""
        assert "of 2 s" in evoframe("simulate", WALKER, "--set", "objective=tip-dz").stderr

    def test_that_does_not_fit_leaves_the_score_out(
        self, evoframe: Evoframe, one_body: Path, tmp_path: Path
    ) -> None:
        command = ("simulate", one_body, "--set", "simulator.duration=0.02")
        simulated = evoframe(*command, "--trace", "trace.csv", "--json")
        assert simulated.returncode == 0, simulated.stderr
        assert len((tmp_path / "trace.csv").read_text().splitlines()) == 9
        result = json.loads(simulated.stdout)
        assert (result["score"], result["objective"], result["diverged"]) == ([None], ["tip-dz"], [False])
        assert (result["first_time"], result["last_time"], result["diverged_at"]) == ([None], [None], [None])
        [reason] = result["missing"]
        assert "sample 5" in reason
        _, row, words = evoframe(*command).stdout.splitlines()
        assert re.split(r"\s{2,}", row.strip()) == ["body.npz", "missing", "tip-dz", "-"]
        assert words.endswith(reason)

    def test_that_is_asked_for_must_fit(self, evoframe: Evoframe, short: Path) -> None:
        for asked in ("objective=tip-yz", "objective.last=7", "objective={name='tip-dz', last=5}"):
            refused = evoframe("simulate", short, "--set", asked, "--trace", "trace.csv")
            assert refused.returncode == 2
            assert refused.stderr.startswith(f"Error: --set {asked}: objective: sample")
            assert not (short.parent / "trace.csv").exists()

    def test_that_does_not_fit_hides_no_divergence(self, evoframe: Evoframe, one_body: Path) -> None:
        wild = ("--set", "simulator.bond_damping=1e4", "--set", "simulator.duration=0.04")
        result = json.loads(evoframe("simulate", one_body, *wild, "--json").stdout)
        assert (result["score"], result["diverged"]) == ([None], [True])
        assert result["diverged_at"][0] > 0
        assert "diverged at step" in evoframe("simulate", one_body, *wild).stdout


def contents(directory: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in directory.iterdir() if path.is_file()}


class TestTracePath:
    """A trace overwrites nothing unasked, and no input at all."""

    def test_that_is_the_input_is_refused(self, evoframe: Evoframe, one_body: Path, tmp_path: Path) -> None:
        before = one_body.read_bytes()
        (tmp_path / "soft.csv").symlink_to(one_body)
        (tmp_path / "hard.csv").hardlink_to(one_body)
        (tmp_path / "sub").mkdir()
        for path in (one_body, "body.npz", "sub/../body.npz", "soft.csv", "hard.csv"):
            refused = evoframe("simulate", one_body, "--trace", path, "--force")
            assert refused.returncode == 2
            assert refused.stderr.startswith(f"Error: {path}: is an input")
            assert one_body.read_bytes() == before

    def test_that_is_a_preset_or_a_plugin_is_refused(self, evoframe: Evoframe, tmp_path: Path) -> None:
        (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
        (tmp_path / "base.toml").write_text('extends = "toy.toml"\n')
        (tmp_path / "mine.py").write_text(Path(toys.__file__).read_text())
        (tmp_path / "one.toy").write_text("designs = [{ a = 2.0 }]\n")
        before = contents(tmp_path)
        command = ("simulate", "-p", "mine.py", "one.toy", "--preset", "base.toml")
        for name in ("mine.py", "base.toml", "toy.toml", "one.toy"):
            traced = evoframe(*command, "--set", "simulator=toy-varied", "--trace", name, "--force")
            assert traced.returncode == 2
            assert traced.stderr.startswith(f"Error: {name}: is an input")
        assert contents(tmp_path) == before

    def test_in_a_run_is_no_file_of_the_run(self, evoframe: Evoframe, tmp_path: Path) -> None:
        assert evoframe("run", "quick", "--set", "run.generations=0", "--out", "here").returncode == 0
        before = contents(tmp_path / "here")
        for name in ("config.toml", "run.db", "champion.json", "verification.json"):
            refused = evoframe("simulate", "here", "--trace", f"here/{name}", "--force")
            assert refused.returncode == 2
            assert refused.stderr.startswith(f"Error: here/{name}: is an input")
        assert contents(tmp_path / "here") == before
        assert evoframe("simulate", "here", "--trace", "here/trace.csv").returncode == 0

    def test_is_standard_output_unless_that_has_json(self, evoframe: Evoframe, one_body: Path) -> None:
        printed = evoframe("simulate", one_body, "--trace", "-").stdout.splitlines()
        assert printed[0].startswith("step,time,")
        assert printed[-1].split()[0] == "body.npz"
        refused = evoframe("simulate", one_body, "--trace", "-", "--json")
        assert (refused.returncode, refused.stdout) == (2, "")
        assert refused.stderr.startswith("Error: --trace -: ")

    def test_with_other_content_is_kept_without_force(
        self, evoframe: Evoframe, one_body: Path, tmp_path: Path
    ) -> None:
        trace = tmp_path / "trace.csv"
        trace.write_text("mine")
        command = ("simulate", one_body, "--trace", "trace.csv")
        refused = evoframe(*command)
        assert refused.returncode == 2
        assert refused.stderr.startswith("Error: trace.csv: ")
        assert "--force" in refused.stderr
        assert trace.read_text() == "mine"
        assert evoframe(*command, "--force").returncode == 0
        assert trace.read_text().startswith("step,time,")
        assert evoframe(*command).returncode == 0  # the same again


def test_a_trace_of_several_bodies_is_refused(evoframe: Evoframe, tmp_path: Path) -> None:
    refused = evoframe("simulate", GOLDEN, "--trace", tmp_path / "trace.csv")
    assert refused.returncode == 2
    assert refused.stderr.startswith("Error: --trace: ")
    assert "36" in refused.stderr


WITH_UNITS = """
import attrs, toys
from evoframe import hookimpl

@attrs.frozen
class Energy(toys.Value):
    unit = "J"

@attrs.frozen
class Length(toys.Value):
    unit = "m"

@hookimpl
def evoframe_objectives():
    return {"energy": Energy, "length": Length}
"""


def test_json_has_an_entry_for_each_design_of_all_files(evoframe: Evoframe, tmp_path: Path) -> None:
    (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
    (tmp_path / "units.py").write_text(WITH_UNITS)
    (tmp_path / "two.toy").write_text("designs = [{ a = 2.0 }, { a = 3.0 }]\n")
    (tmp_path / "one.toy").write_text("designs = [{ a = 4.0 }]\n")
    command = ["simulate", "-p", toys.__file__, "-p", "units.py", "two.toy", "one.toy", "--json"]
    command += ["--preset", "toy.toml", "--set", "simulator=toy-varied"]
    surroundings = {"PYTHONPATH": str(Path(toys.__file__).parent)}
    lengths = json.loads(evoframe(*command, "--set", "objective=length", **surroundings).stdout)
    assert lengths == {
        "labels": ["two.toy[0]", "two.toy[1]", "one.toy[0]"],
        "score": [2.0, 3.0, 4.0],
        "objective": ["length"] * 3,
        "unit": ["m"] * 3,
        "first_time": [1.0] * 3,
        "last_time": [1.0] * 3,
        "diverged": [False] * 3,
        "diverged_at": [None] * 3,
        "missing": [None] * 3,
        "displacement": [2.0, 3.0, 4.0],
    }
    energies = json.loads(evoframe(*command, "--set", "objective=energy", **surroundings).stdout)
    del lengths["displacement"]
    assert energies == {**lengths, "objective": ["energy"] * 3, "unit": ["J"] * 3}
    command.remove("--json")
    header, first, *_ = evoframe(*command, "--set", "objective=energy", **surroundings).stdout.splitlines()
    assert header.split() == ["design", "score", "objective", "measured"]
    assert first.split() == ["two.toy[0]", "2", "J", "energy", "1", "s", "to", "1", "s"]


def test_a_simulation_that_diverges_is_said_to(evoframe: Evoframe, one_body: Path) -> None:
    wild = ["--set", "simulator.bond_damping=1e4"]
    result = json.loads(evoframe("simulate", one_body, "--json", *wild).stdout)
    assert result["displacement"] == result["score"] == [None]
    assert (result["diverged"], result["diverged_at"]) == ([True], [ANY])
    assert result["diverged_at"][0] > 0
    assert "diverged at step" in evoframe("simulate", one_body, *wild).stdout


def arrays(**given: Any) -> Callable[[Path], None]:
    return lambda path: np.savez(path, **given)


def written(member: str, content: bytes) -> Callable[[Path], None]:
    def write(path: Path) -> None:
        with zipfile.ZipFile(path, "w") as archive:
            archive.writestr(member, content)

    return write


CELLS = (4, 2, 2)
SOLID = np.ones(CELLS, np.uint8)
ZERO = np.zeros(CELLS)


@pytest.mark.parametrize(
    ("write", "message"),
    [
        (None, "does not exist"),
        (Path.mkdir, "config.toml"),
        (lambda path: path.write_bytes(GOLDEN.read_bytes()[:5000]), ".npz"),
        (written("material.npy", b"1, 1, 3"), "EOF"),
        (
            written("bodies.npy", b""),
            "material: ",
        ),
        (arrays(material=SOLID * 2, phase_cycles=ZERO), "material: unknown code 2"),
        (
            arrays(material=SOLID, phase_cycles=np.full(CELLS, np.iinfo(np.int64).min)),
            "phase_cycles: found 9.22337e+18",
        ),
    ],
)
def test_what_is_no_body_is_refused_by_name(
    evoframe: Evoframe, tmp_path: Path, write: Any, message: str
) -> None:
    path = tmp_path / "given.npz"
    if write is not None:
        write(path)
    refused = evoframe("simulate", path)
    assert refused.returncode == 2
    assert "Traceback" not in refused.stderr
    assert f"{path}: " in refused.stderr
    assert message in refused.stderr


@pytest.mark.parametrize("text", ["", "{}", '{"format": 1}', "[]"])
def test_what_is_no_champion_is_refused_by_name(evoframe: Evoframe, tmp_path: Path, text: str) -> None:
    path = tmp_path / "given.json"
    path.write_text(text)
    refused = evoframe("simulate", path)
    assert (refused.returncode, str(path) in refused.stderr, "Traceback" in refused.stderr) == (
        2,
        True,
        False,
    )


class TestChampion:
    @pytest.fixture
    def champion(self, evoframe: Evoframe, tmp_path: Path) -> Path:
        assert evoframe("run", "quick", "--set", "objective=face-yz", "--out", "here").returncode == 0
        return tmp_path / "here" / "champion.json"

    def test_gives_its_displacement_again_to_the_last_bit(self, evoframe: Evoframe, champion: Path) -> None:
        recorded = json.loads(champion.read_text())["score"]
        assert json.loads(evoframe("simulate", champion, "--json").stdout)["displacement"] == [recorded]

    def test_is_simulated_as_a_preset_does_on_demand(self, evoframe: Evoframe, champion: Path) -> None:
        recorded = json.loads(champion.read_text())["score"]
        [other] = json.loads(evoframe("simulate", champion, "--preset", "paper", "--json").stdout)[
            "displacement"
        ]
        assert other != recorded

    def test_with_a_setting_that_does_not_exist_names_the_file(
        self, evoframe: Evoframe, champion: Path
    ) -> None:
        document = json.loads(champion.read_text())
        document["simulation"]["simulator"]["speed"] = 3
        champion.write_text(json.dumps(document))
        refused = evoframe("simulate", champion)
        assert refused.returncode == 2
        assert f"{champion}: simulator.speed: " in refused.stderr

    @pytest.mark.parametrize(
        ("role", "field", "wrong", "message"),
        [
            ("morphology", "values", lambda array: [7] * len(array["values"]), "material: unknown code 7"),
            ("morphology", "shape", lambda array: [len(array["values"])], "morphology: found uint8["),
            ("controller", "shape", lambda array: [len(array["values"])], "controller: found float64["),
            ("controller", "values", lambda array: [1e300] * len(array["values"]), "the phase"),
        ],
    )
    def test_with_a_design_of_another_simulator_is_refused(
        self, evoframe: Evoframe, champion: Path, role: str, field: str, wrong: Any, message: str
    ) -> None:
        document = json.loads(champion.read_text())
        document["design"][role][field] = wrong(document["design"][role])
        champion.write_text(json.dumps(document))
        refused = evoframe("simulate", champion)
        assert refused.returncode == 2
        assert "Traceback" not in refused.stderr
        assert "Warning" not in refused.stderr
        assert f"{champion}: {message}" in refused.stderr

    def test_without_a_role_is_refused(self, evoframe: Evoframe, champion: Path) -> None:
        document = json.loads(champion.read_text())
        del document["design"]["controller"]
        champion.write_text(json.dumps(document))
        assert re.search(f"{champion}: design: .*controller", evoframe("simulate", champion).stderr)
