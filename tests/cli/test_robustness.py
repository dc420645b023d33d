"""``evoframe robustness``."""

from __future__ import annotations

import csv
import json
import re
import shutil
from pathlib import Path

import pytest
import toys
from processes import Evoframe, on_a_terminal, python

from evoframe.analysis.robustness import read_robustness

TOYS = ["-p", toys.__file__]
ALONE = [*TOYS, "--published", "--preset", "toy.toml", "--set", "simulator=toy-steered"]


@pytest.fixture(scope="module")
def made_runs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    directory = tmp_path_factory.mktemp("runs")
    (directory / "toy.toml").write_text(toys.CONFIGURATION)
    for seed in (1, 2):
        settings = ["--set", "simulator=toy-steered", "--set", "objective=toy-late", "--seed", seed]
        command = ["-m", "evoframe", "run", *TOYS, "toy.toml", *settings, "--out", f"run-{seed}"]
        made = python(*command, directory=directory)
        assert made.returncode == 0, made.stderr
    return directory


@pytest.fixture
def toy_runs(made_runs: Path, tmp_path: Path) -> list[str]:
    shutil.copytree(made_runs, tmp_path, dirs_exist_ok=True)
    return ["run-1", "run-2"]


@pytest.fixture
def toy_preset(tmp_path: Path) -> None:
    (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)


def contents(directory: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in directory.iterdir()}


class TestRuns:
    def test_are_measured_into_files_and_words(
        self, evoframe: Evoframe, toy_runs: list[str], tmp_path: Path
    ) -> None:
        made = evoframe("robustness", *TOYS, *toy_runs, "--published", "--controllers", 30)
        assert made.returncode == 0, made.stderr
        head, *rows = made.stdout.split("\n\n")[0].splitlines()
        assert re.split(r"\s{2,}", head.strip()) == [
            "bodies", "median (mm)", "quartiles", "range", "positive", "diverged",
        ]  # fmt: skip
        assert [row.split()[0] for row in rows] == ["run-1", "run-2", "one", "two"]
        assert made.stderr == "14 files written to robustness\n"
        measured = read_robustness(tmp_path / "robustness")
        assert measured.scores.shape == (30, 4)
        assert (measured.scores[:, 3] == 2 * measured.scores[:, 2]).all()
        words = (tmp_path / "robustness" / "conclusions.txt").read_text()
        assert words in made.stdout

    def test_give_the_same_files_again_for_any_number_of_workers(
        self, evoframe: Evoframe, toy_runs: list[str], tmp_path: Path
    ) -> None:
        command = ["robustness", *TOYS, *toy_runs, "--controllers", 30, "--out", "here"]
        assert evoframe(*command).returncode == 0
        before = contents(tmp_path / "here")
        assert evoframe(*command, "--set", "executor={name='threads', workers=3}").returncode == 0
        assert contents(tmp_path / "here") == before

    def test_that_is_alone_has_its_results_in_its_directory(
        self, evoframe: Evoframe, toy_runs: list[str], tmp_path: Path
    ) -> None:
        made = evoframe("robustness", *TOYS, "run-1", "--controllers", 5, "-q")
        assert made.returncode == 0, made.stderr
        assert made.stderr == ""
        assert (tmp_path / "run-1" / "robustness" / "violins.pdf").is_file()
        assert evoframe("doctor", *TOYS, "run-1").returncode == 0
        assert evoframe("robustness", *TOYS, "run-1", "--published", "--controllers", 5).returncode == 2

    def test_are_measured_otherwise_only_by_force(self, evoframe: Evoframe, toy_runs: list[str]) -> None:
        command = ["robustness", *TOYS, *toy_runs, "--controllers", 5]
        assert evoframe(*command).returncode == 0
        refused = evoframe(*command, "--seed", 2)
        assert refused.returncode == 2
        message, difference = refused.stderr.splitlines()
        assert message.startswith("Error: robustness/robustness.json: ")
        assert "--force" in message
        assert re.fullmatch("  seed: .*1.*2.*", difference)
        assert evoframe(*command, "--correction", "none").returncode == 0  # the same scores
        assert evoframe(*command, "--seed", 2, "--force").returncode == 0

    def test_as_json_have_everything(self, evoframe: Evoframe, toy_runs: list[str], tmp_path: Path) -> None:
        made = evoframe("robustness", *TOYS, *toy_runs, "--controllers", 5, "--json")
        document = json.loads(made.stdout)
        assert document["controllers"] == 5
        assert [body["source"] for body in document["bodies"]] == toy_runs
        with (tmp_path / "robustness" / "scores.csv").open() as file:
            rows = list(csv.reader(file))
        assert rows[0] == ["controller", *toy_runs]
        assert [[float(cell) for cell in row[1:]] for row in rows[1:]] == document["scores"]
        assert document["tables"]["ranking"][0]["test"] == "Kruskal-Wallis"


class TestStudy:
    def test_has_a_group_for_each_configuration(
        self, evoframe: Evoframe, toy_preset: None, tmp_path: Path
    ) -> None:
        (tmp_path / "grid.toml").write_text(
            'extends = "toy.toml"\nruns = 2\nsimulator = "toy-steered"\n'
            '[grid]\n"collaboration.n" = [1, 2]\naggregator = ["toy-mean"]\n'
        )
        assert evoframe("study", *TOYS, "grid.toml", "--out", "s").returncode == 0
        made = evoframe("robustness", *TOYS, "s", "--controllers", 20)
        assert made.returncode == 0, made.stderr
        assert re.search(r"toy-mean \(n = [12]\) [>=] toy-mean \(n = [12]\)", made.stdout)
        groups = read_robustness(tmp_path / "s" / "robustness").setting.groups
        assert groups == {"toy-mean (n = 1)": [0, 1], "toy-mean (n = 2)": [2, 3]}
        again = evoframe("study", *TOYS, "grid.toml", "--out", "s")
        assert again.returncode == 0, again.stderr
        assert evoframe("report", *TOYS, "s").returncode == 0


class TestPublished:
    def test_needs_no_run(self, evoframe: Evoframe, toy_preset: None) -> None:
        made = evoframe("robustness", *ALONE, "--controllers", 40)
        assert made.returncode == 0, made.stderr
        assert [line.split()[0] for line in made.stdout.splitlines()[1:3]] == ["one", "two"]

    def test_that_diverges_is_counted_and_has_no_score(
        self, evoframe: Evoframe, toy_preset: None, tmp_path: Path
    ) -> None:
        made = evoframe("robustness", *ALONE, "--controllers", 40, "--set", "simulator.most=1.0")
        assert made.returncode == 0, made.stderr
        measured = read_robustness(tmp_path / "robustness")
        lost = len(measured.diverged)
        assert lost > 0
        assert re.search(rf"\n two .* {lost} \n", made.stdout)
        assert re.search(rf"\b{lost} simulations diverged.*\b{lost} .*two", made.stdout)

    def test_where_everything_diverges_there_are_no_figures(
        self, evoframe: Evoframe, toy_preset: None
    ) -> None:
        made = evoframe("robustness", *ALONE, "--controllers", 4, "--set", "simulator.most=-9.0")
        assert made.returncode == 0, made.stderr
        assert re.search(r"\n two +1 +4 \n", made.stdout)


class TestRefused:
    @pytest.mark.parametrize(
        ("arguments", "message"),
        [
            ([], "--published"),
            (["nowhere"], "Error: nowhere: "),
            (["--published", "--set", "simulator.speed=1"], "simulator.speed: "),
            (["--published", "--controllers", "0"], "0 is not in the range"),
            (["--published", "--correction", "luck"], "'luck' is not one of"),
        ],
    )
    def test_is_what_cannot_be_measured(self, evoframe: Evoframe, arguments: list[str], message: str) -> None:
        refused = evoframe("robustness", *arguments)
        assert refused.returncode == 2
        assert message in refused.stderr
        assert "Traceback" not in refused.stderr

    def test_is_a_directory_of_something_else(
        self, evoframe: Evoframe, toy_preset: None, tmp_path: Path
    ) -> None:
        (tmp_path / "robustness").mkdir()
        (tmp_path / "robustness" / "letter.txt").write_text("Dear")
        refused = evoframe("robustness", *ALONE, "--force")
        assert refused.returncode == 2
        assert refused.stderr.startswith("Error: robustness: ")

    def test_is_a_place_that_cannot_be_written_to(
        self, evoframe: Evoframe, toy_preset: None, tmp_path: Path
    ) -> None:
        (tmp_path / "file").write_text("")
        refused = evoframe("robustness", *ALONE, "--out", "file/there")
        assert refused.returncode == 2
        assert refused.stderr.startswith("Error: file/there: ")
        assert "Not a directory" in refused.stderr

    def test_is_a_program_without_statistics(self, tmp_path: Path) -> None:
        program = "import sys; sys.modules['matplotlib'] = None; from evoframe.cli import main; main()"
        refused = python("-c", program, "robustness", "--published", directory=tmp_path)
        assert refused.returncode == 2
        assert "matplotlib" in refused.stderr
        assert "pip install '.[report]'" in refused.stderr


def test_measuring_from_python_needs_no_statistics(tmp_path: Path) -> None:
    program = (
        "import sys; sys.modules['matplotlib'] = sys.modules['pandas'] = None; import evoframe; "
        "print(evoframe.measure_robustness(published=True, controllers=2).scores.shape)"
    )
    assert python("-c", program, directory=tmp_path).stdout == "(2, 3)\n"


def test_scores_that_overlook_the_end_are_warned_of(evoframe: Evoframe) -> None:
    command = ("robustness", "--published", "--controllers", 3, "--set", "simulator.duration=0.14")
    made = evoframe(*command, "--json")
    assert made.returncode == 0, made.stderr
    assert "looks at the first 0.067 s of 0.14 s\n" in made.stderr


def test_a_terminal_sees_how_many_simulations_are_done(toy_preset: None, tmp_path: Path) -> None:
    shown = on_a_terminal(["robustness", *ALONE, "--controllers", "300"], tmp_path)
    assert "of 600 simulations" in shown


def test_the_published_bodies_are_ranked_as_in_the_paper(evoframe: Evoframe, tmp_path: Path) -> None:
    """docs/experiment.md, "The experiments": without a correction, as there."""
    made = evoframe("robustness", "--published", "--controllers", 60, "--correction", "none")
    assert made.returncode == 0, made.stderr
    rankings = re.findall(r"\w+ [>=] \w+ [>=] \w+", made.stdout)
    assert {"NEAT = HyperNEAT > AFPO", "HyperNEAT = NEAT > AFPO"} & set(rankings)
    measured = read_robustness(tmp_path / "robustness")
    assert measured.setting.unit == "m"
    assert measured.setting.simulation["simulator"]["phase_unit"] == "cycles"


def test_a_champion_of_the_quick_preset_is_measured_beside_them(evoframe: Evoframe, tmp_path: Path) -> None:
    assert evoframe("run", "quick", "--set", "run.generations=1", "--out", "here").returncode == 0
    made = evoframe("robustness", "here", "--published", "--controllers", 4)
    assert made.returncode == 0, made.stderr
    measured = read_robustness(tmp_path / "here" / "robustness")
    assert [body.label for body in measured.setting.bodies] == ["here", "AFPO", "HyperNEAT", "NEAT"]
