"""``evoframe verify``."""

from __future__ import annotations

import json
import re
from pathlib import Path
from unittest.mock import ANY

import numpy as np
import pytest
import toys
from bars import torn
from processes import Evoframe
from recorded import written

from evoframe import load_run
from evoframe.messages import quantity

TOYS = ["-p", toys.__file__]
PUBLISHED = Path(__file__).parents[1] / "data" / "paper_preset.npz"


@pytest.fixture
def toy_run(evoframe: Evoframe, tmp_path: Path) -> Path:
    (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
    settings = ["--set", "simulator=toy-varied", "--set", "objective=toy-late"]
    assert evoframe("run", *TOYS, "toy.toml", *settings, "--out", "here").returncode == 0
    return tmp_path / "here"


@pytest.fixture
def designs(tmp_path: Path) -> Path:
    (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
    path = tmp_path / "two.toy"
    path.write_text("designs = [{ a = 2.0, b = 3.0 }, { a = -1.0 }]\nsettings = { gain = 2.0 }\n")
    return path


@pytest.fixture
def published(tmp_path: Path) -> Path:
    """The three published bodies (docs/experiment.md): AFPO, NEAT and HyperNEAT."""
    path = tmp_path / "published.npz"
    with np.load(PUBLISHED) as data:
        chosen = {name: data[name][[0, 3, 6]] for name in ("material", "phase_cycles")}
    np.savez(path, **chosen)
    return path


def columns(line: str) -> list[str]:
    return re.split(r"\s{2,}", line.strip())


class TestRun:
    def test_prints_what_is_left_of_its_champions_score(self, evoframe: Evoframe, toy_run: Path) -> None:
        score = load_run(toy_run).champion().score
        verified = evoframe("verify", *TOYS, "here")
        assert verified.returncode == 0, verified.stderr
        title, measure, *table, verdict = verified.stdout.splitlines()
        assert measure == "objective toy-late, in mm, from 1 s to 1 s"
        assert verdict.startswith("The score comes from gain (0% of unchanged)")
        least, middle, greatest = (quantity(factor * score, "m") for factor in (0.9, 1.0, 1.1))
        assert title == "here"
        assert [columns(line) for line in table] == [
            ["variant", "score", "of unchanged"],
            ["unchanged", middle, "100%"],
            ["gain off", "0 mm", "0%"],
            ["no room", "diverged at step 1", "-"],
            [
                "one number jittered by 10 %",
                f"{middle}, {least} to {greatest} in 4 draws",
                "100%",
            ],
        ]

    def test_is_kept_in_its_directory(self, evoframe: Evoframe, toy_run: Path) -> None:
        path = toy_run / "verification.json"
        before = path.read_bytes()
        path.unlink()
        [document] = json.loads(evoframe("verify", *TOYS, "here", "--json", "--set", "run.seed=9").stdout)
        assert path.read_bytes() == before
        measure = {"objective": "toy-late", "first_time": 1.0, "last_time": 1.0}
        assert {"body": "here", **measure, **json.loads(before)} == document

    @pytest.mark.parametrize("change", [["--set", "simulator.gain=2"], ["--preset", "toy.toml"]])
    def test_with_other_settings_is_not_kept(
        self, evoframe: Evoframe, toy_run: Path, change: list[str]
    ) -> None:
        before = written(toy_run)
        settings = ["--set", "simulator.name=toy-varied"] if "--preset" in change else []
        verified = evoframe("verify", *TOYS, "here", *change, *settings)
        assert verified.returncode == 0, verified.stderr
        assert written(toy_run) == before

    def test_of_another_machine_shows_both_scores(self, evoframe: Evoframe, toy_run: Path) -> None:
        path = toy_run / "champion.json"
        champion = json.loads(path.read_text())
        champion["score"] = 0.125
        path.write_text(json.dumps(champion))
        table = evoframe("verify", *TOYS, path).stdout.splitlines()
        assert columns(table[-2]) == ["score in the run", "125 mm"]

    def test_that_is_no_run_is_refused(self, evoframe: Evoframe, tmp_path: Path) -> None:
        (tmp_path / "empty").mkdir()
        refused = evoframe("verify", "empty")
        assert refused.returncode == 2
        assert refused.stderr.startswith("Error: empty: ")
        assert "config.toml" in refused.stderr


class TestFile:
    def test_has_a_table_for_each_design_with_its_own_settings(
        self, evoframe: Evoframe, designs: Path
    ) -> None:
        settings = ["--preset", "toy.toml", "--set", "simulator=toy-varied"]
        lines = evoframe("verify", *TOYS, designs.name, *settings).stdout.splitlines()
        assert [columns(line)[:2] for line in lines if line.startswith((" unchanged", "two"))] == [
            ["two.toy[0]"],
            ["unchanged", "12"],
            ["two.toy[1]"],
            ["unchanged", "-2"],
        ]
        assert lines[1] == "objective toy-value, from 1 s to 1 s"
        assert columns(lines[2]) == ["variant", "score", "of unchanged"]

    def test_as_json_has_full_precision(self, evoframe: Evoframe, designs: Path) -> None:
        settings = ["--preset", "toy.toml", "--set", "simulator={name='toy-varied', gain=0.1}"]
        documents = json.loads(evoframe("verify", *TOYS, designs.name, *settings, "--json").stdout)
        assert [document["body"] for document in documents] == ["two.toy[0]", "two.toy[1]"]
        assert documents[0]["score"] is None
        jittered = documents[0]["variants"][-1]
        assert jittered["least"] == 0.1 * (2.0 * 0.9 * 3.0)

    def test_without_variants_is_refused(self, evoframe: Evoframe, toy_run: Path) -> None:
        refused = evoframe("verify", *TOYS, "here", "--set", "simulator=toy-product")
        assert refused.returncode == 2
        assert refused.stderr.startswith("Error: here: ")
        assert "'toy-product'" in refused.stderr

    def test_with_a_mistake_in_what_is_set_is_refused(self, evoframe: Evoframe, toy_run: Path) -> None:
        refused = evoframe("verify", *TOYS, "here", "--set", "simulator.speed=1")
        assert refused.returncode == 2
        assert "--set simulator.speed=1: simulator.speed: " in refused.stderr


def test_a_walker_does_not_travel_without_contraction(evoframe: Evoframe) -> None:
    walker = Path(__file__).parents[1] / "data" / "measures" / "walker.vxa"
    [document] = json.loads(evoframe("verify", walker, "--json").stdout)
    measure = (document["objective"], document["unit"], document["first_time"], document["last_time"])
    assert measure == ("travel", "m", pytest.approx(0.3, abs=5e-4), pytest.approx(2.00028424, abs=1e-8))
    shares = {row["name"]: row["share"] for row in document["variants"]}
    assert abs(shares["contraction off"]) < 0.005
    assert shares["twice the duration"] == pytest.approx(2.06, abs=0.01)  # at the end of 4 s
    printed = evoframe("verify", walker).stdout
    assert "objective travel, in mm, from 0.3 s to 2 s" in printed
    assert "The score comes from contraction (0% of unchanged)" in printed


def test_a_body_that_is_torn_apart_out_of_reach_of_its_score_is_seen(
    evoframe: Evoframe, tmp_path: Path
) -> None:
    roles = torn().roles
    np.savez(tmp_path / "torn.npz", material=roles["morphology"], phase_cycles=roles["controller"])
    settings = ["--set", "simulator.largest_strain=0.14"]
    [score] = json.loads(evoframe("simulate", "torn.npz", *settings, "--json").stdout)["score"]
    assert score > 1e-4
    *_, unchanged, within, _, _, _, _, _, verdict = evoframe(
        "verify", "torn.npz", *settings
    ).stdout.splitlines()
    assert columns(unchanged) == ["unchanged", "diverged at step 2", "-"]
    assert columns(within) == ["within reach of the samples", quantity(score, "m"), "-"]
    assert verdict == (
        f"The design diverges at step 2, out of reach of the samples; its score of {quantity(score, 'm')} "
        "does not show it."
    )
    [document] = json.loads(evoframe("verify", "torn.npz", *settings, "--json").stdout)
    assert [row["median"] for row in document["variants"][:2]] == [None, score]


def test_a_score_that_overlooks_the_end_is_warned_of(evoframe: Evoframe, published: Path) -> None:
    verified = evoframe("verify", published, "--set", "simulator.duration=0.25", "--json")
    assert verified.stderr.endswith("looks at the first 0.067 s of 0.25 s\n")
    assert len(json.loads(verified.stdout)) == 3


def test_the_published_bodies_move_without_contraction_and_hardly_without_collisions(
    evoframe: Evoframe, published: Path
) -> None:
    """docs/experiment.md, "What the setting rewards"."""
    documents = json.loads(evoframe("verify", published, "--json", "--workers", 2).stdout)
    tables = [{row["name"]: row for row in document["variants"]} for document in documents]
    still = [table["contraction off"]["median"] for table in tables]
    assert still == pytest.approx([0.0011106, 0.0019527, 0.0020189], abs=5e-8)
    for table in tables:
        assert abs(table["self collision off"]["share"]) < 0.5
        assert 0.8 < table["offsets jittered by 1 %"]["share"] < 1.2
        assert len(table["offsets jittered by 1 %"]["draws"]) > 1


def test_a_champion_of_the_paper_is_verified_with_its_run(evoframe: Evoframe, tmp_path: Path) -> None:
    ran = evoframe("run", "quick", "--set", "run.generations=1", "--out", "here")
    assert ran.returncode == 0, ran.stderr
    assert re.search(r"\n contraction off +\S+ mm +-?\d+%", ran.stdout)
    kept = json.loads((tmp_path / "here" / "verification.json").read_text())
    [verified] = json.loads(evoframe("verify", "here", "--json", "--workers", 1).stdout)
    measure = {"objective": "tip-dz", "first_time": ANY, "last_time": ANY}
    assert verified == {"body": "here", **measure, **kept}
    assert verified["first_time"] == pytest.approx(0.0032029, abs=1e-7)
    assert verified["last_time"] == pytest.approx(21 * 0.0032029, abs=1e-6)
    assert kept["score"] == kept["variants"][0]["median"]
