"""``evoframe export``."""

from __future__ import annotations

import json
import os
from pathlib import Path

import numpy as np
import pytest
import toys
from processes import Evoframe

TOYS = ["-p", toys.__file__]


@pytest.fixture
def toy_run(evoframe: Evoframe, tmp_path: Path) -> Path:
    (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
    command = ["run", *TOYS, "toy.toml", "--set", "simulator=toy-varied", "--out", "here"]
    assert evoframe(*command).returncode == 0
    return tmp_path / "here"


class TestRun:
    def test_is_written_beside_its_champion(self, evoframe: Evoframe, toy_run: Path) -> None:
        path = toy_run / "champion.toy"
        before = path.read_bytes()
        for _ in range(2):  # what is there already is no obstacle
            exported = evoframe("export", *TOYS, "here", "--to", "toy")
            assert (exported.stdout, exported.stderr) == ("here/champion.toy\n", "")
            assert path.read_bytes() == before
            path.unlink()

    def test_goes_where_it_is_sent(self, evoframe: Evoframe, toy_run: Path, tmp_path: Path) -> None:
        exported = evoframe("export", *TOYS, "here", "--to", "toy", "--out", "mine.txt")
        assert exported.stdout == "mine.txt\n"
        assert (tmp_path / "mine.txt").read_bytes() == (toy_run / "champion.toy").read_bytes()

    def test_goes_to_standard_output(self, evoframe: Evoframe, toy_run: Path) -> None:
        exported = evoframe("export", *TOYS, "here", "--to", "toy", "--out", "-")
        assert exported.stdout == (toy_run / "champion.toy").read_text()

    def test_with_other_settings_does_not_replace_its_file(self, evoframe: Evoframe, toy_run: Path) -> None:
        path = toy_run / "champion.toy"
        before = path.read_bytes()
        command = ["export", *TOYS, "here", "--to", "toy", "--set", "simulator.gain=5"]
        refused = evoframe(*command)
        assert refused.returncode == 2
        assert refused.stderr.startswith("Error: here/champion.toy: ")
        assert "--force" in refused.stderr
        assert path.read_bytes() == before
        assert evoframe(*command, "--force").returncode == 0
        assert "gain = 5.0" in path.read_text()

    def test_names_what_the_format_cannot_say(self, evoframe: Evoframe, toy_run: Path) -> None:
        command = ["export", *TOYS, "here", "--to", "txt", "--set", "simulator.gain=5", "--out", "-"]
        exported = evoframe(*command)
        assert exported.returncode == 0
        assert exported.stderr == "Warning: not exported: gain\nWarning: not exported: limit\n"

    def test_unknown_formats_are_answered_with_those_there_are(
        self, evoframe: Evoframe, toy_run: Path
    ) -> None:
        refused = evoframe("export", *TOYS, "here", "--to", "tyo")
        assert refused.returncode == 2
        for part in ("'toy-varied'", "'tyo'", "'toy'", "toy, txt"):
            assert part in refused.stderr

    def test_a_simulator_without_formats_is_said(self, evoframe: Evoframe, toy_run: Path) -> None:
        refused = evoframe("export", *TOYS, "here", "--to", "toy", "--set", "simulator=toy-product")
        assert refused.returncode == 2
        assert "'toy-product'" in refused.stderr


class TestPath:
    def test_that_is_a_directory_is_refused(self, evoframe: Evoframe, toy_run: Path) -> None:
        refused = evoframe("export", *TOYS, "here", "--to", "toy", "--out", "here", "--force")
        assert (refused.returncode, refused.stderr.startswith("Error: here: ")) == (2, True)

    def test_in_a_directory_that_is_not_there_is_refused(self, evoframe: Evoframe, toy_run: Path) -> None:
        refused = evoframe("export", *TOYS, "here", "--to", "toy", "--out", "no/where.toy")
        assert refused.returncode == 2
        assert "Error: no/where.toy: " in refused.stderr

    def test_that_is_a_device_is_written_to_and_stays_one(
        self, evoframe: Evoframe, toy_run: Path, tmp_path: Path
    ) -> None:
        pipe = tmp_path / "pipe"
        os.mkfifo(pipe)
        reading = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
        exported = evoframe("export", *TOYS, "here", "--to", "toy", "--out", "pipe")
        assert exported.returncode == 0, exported.stderr
        assert os.read(reading, 2**16) == (toy_run / "champion.toy").read_bytes()
        os.close(reading)
        assert pipe.is_fifo()


class TestFile:
    def test_is_written_with_another_ending(self, evoframe: Evoframe, tmp_path: Path) -> None:
        (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
        (tmp_path / "one.toy").write_text("designs = [{ a = 2.0 }]\nsettings = { gain = 2.0 }\n")
        settings = ["--preset", "toy.toml", "--set", "simulator=toy-varied"]
        exported = evoframe("export", *TOYS, "one.toy", "--to", "txt", *settings)
        assert exported.stdout == "one.txt\n"
        assert (tmp_path / "one.txt").read_text() == "{'a': 2.0}\n"

    def test_is_not_overwritten_by_itself(self, evoframe: Evoframe, tmp_path: Path) -> None:
        path = tmp_path / "one.toy"
        (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
        path.write_text("# mine\ndesigns = [{ a = 2.0 }]\nsettings = { gain = 2.0 }\n")
        before = path.read_bytes()
        command = ["export", *TOYS, "one.toy", "--to", "toy", "--preset", "toy.toml", "--force"]
        command += ["--set", "simulator=toy-varied"]
        for out in ([], ["--out", "./one.toy"], ["--out", "toy.toml"]):
            refused = evoframe(*command, *out)
            assert refused.returncode == 2
            assert "is an input" in refused.stderr
        assert path.read_bytes() == before
        assert (tmp_path / "toy.toml").read_text() == toys.CONFIGURATION

    def test_that_is_too_short_for_the_objective_is_exported(
        self, evoframe: Evoframe, tmp_path: Path
    ) -> None:
        path = tmp_path / "body.npz"
        np.savez(path, material=np.ones((3, 2, 2), np.uint8), phase_cycles=np.zeros((3, 2, 2)))
        exported = evoframe("export", path, "--to", "vxa", "--set", "simulator.duration=0.01")
        assert exported.returncode == 0, exported.stderr
        assert "0.01" in path.with_suffix(".vxa").read_text()

    def test_with_several_designs_is_refused(self, evoframe: Evoframe, tmp_path: Path) -> None:
        path = tmp_path / "bodies.npz"
        np.savez(path, material=np.ones((2, 3, 2, 2), np.uint8), phase_cycles=np.zeros((2, 3, 2, 2)))
        refused = evoframe("export", path, "--to", "vxa")
        assert refused.returncode == 2
        assert f"{path}: " in refused.stderr
        assert "found 2" in refused.stderr

    def test_that_is_no_body_is_refused_with_its_name(self, evoframe: Evoframe, tmp_path: Path) -> None:
        path = tmp_path / "champion.json"
        path.write_text("{}")
        refused = evoframe("export", path, "--to", "vxa")
        assert refused.returncode == 2
        assert f"Error: {path}: " in refused.stderr


class TestVxa:
    """The format of the built-in simulator, from here to there and back."""

    @pytest.fixture
    def body(self, tmp_path: Path) -> Path:
        rng = np.random.default_rng(4)
        path = tmp_path / "body.npz"
        material = rng.choice(np.array([1, 3], np.uint8), (5, 3, 3))
        np.savez(path, material=material, phase_cycles=rng.uniform(-1, 1, (5, 3, 3)))
        return path

    def test_brings_its_own_settings_back(self, evoframe: Evoframe, body: Path) -> None:
        settings = ["--set", "simulator.duration=0.09", "--set", "simulator.density=2e6"]
        exported = evoframe("export", body, "--to", "vxa", *settings)
        assert exported.returncode == 0, exported.stderr
        there = evoframe("simulate", body, "--json", *settings).stdout
        back = evoframe("simulate", body.with_suffix(".vxa"), "--preset", "paper", "--json").stdout
        [first], [second] = (json.loads(text)["displacement"] for text in (there, back))
        assert second == pytest.approx(first, rel=1e-6)

    def test_yields_to_what_is_set(self, evoframe: Evoframe, body: Path) -> None:
        exported = evoframe("export", body, "--to", "vxa", "--set", "simulator.duration=0.02")
        assert exported.returncode == 0, exported.stderr
        vxa = body.with_suffix(".vxa")
        times = []
        for settings in ([], ["--set", "simulator.duration=0.04"]):
            [time] = json.loads(evoframe("simulate", vxa, "--json", *settings).stdout)["last_time"]
            times.append(time)
        assert 0.02 < times[0] < 0.03
        assert 0.04 < times[1] < 0.05
        refused = evoframe("simulate", vxa, "--set", "objective=tip-dz")
        assert refused.returncode == 2
        assert "--set objective=tip-dz: objective: sample 5" in refused.stderr

    def test_of_a_run_is_its_champion(self, evoframe: Evoframe, tmp_path: Path) -> None:
        assert evoframe("run", "quick", "--set", "run.generations=1", "--out", "here").returncode == 0
        recorded = json.loads((tmp_path / "here" / "champion.json").read_text())["score"]
        scored = evoframe("simulate", "here/champion.vxa", "--preset", "paper", "--json").stdout
        [score] = json.loads(scored)["displacement"]
        assert score == pytest.approx(recorded, rel=1e-6)
