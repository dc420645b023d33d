"""``evoframe report``."""

from __future__ import annotations

import csv
import shutil
from pathlib import Path

import pytest
import toys
from processes import Evoframe, python, started, told
from toy_study import STUDY

VERIFIED = ("verification.csv", "verification.tex")
ALWAYS = ("report.html", "report.json")
NAMES = [
    f"{kind}-{yardstick}-{view}"
    for kind in ("curves", "finals")
    for yardstick in ("score", "fitness")
    for view in ("n-1", "n-2", "best-of-each")
]


@pytest.fixture
def study(evoframe: Evoframe, tmp_path: Path) -> list[str]:
    (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
    (tmp_path / "grid.toml").write_text(STUDY)
    made = evoframe("study", "-p", toys.__file__, "grid.toml", "--out", "s")
    assert made.returncode == 0, made.stderr
    return ["-p", toys.__file__, "s"]


def contents(directory: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in directory.iterdir()}


def test_writes_figures_tables_and_words(evoframe: Evoframe, study: list[str], tmp_path: Path) -> None:
    made = evoframe("report", *study)
    assert made.returncode == 0, made.stderr
    written = contents(tmp_path / "s" / "report")
    figures = {f"{name}.{ending}" for name in NAMES for ending in ("pdf", "svg", "png")}
    tables = {f"{name}.{ending}" for name in ("summary", "pairs", "ranking") for ending in ("csv", "tex")}
    assert set(written) == {*figures, *tables, *VERIFIED, *ALWAYS, "conclusions.txt"}
    assert written["curves-score-n-1.pdf"].startswith(b"%PDF")
    assert written["curves-score-n-1.png"].startswith(b"\x89PNG")
    assert b"<svg" in written["curves-score-n-1.svg"]
    rankings = list(csv.DictReader(written["ranking.csv"].decode().splitlines()))
    assert [(row["view"], row["yardstick"]) for row in rankings] == [
        (view, yardstick) for yardstick in ("score", "fitness") for view in ("n = 1", "n = 2", "best of each")
    ]
    assert written["summary.tex"].startswith(b"% requires")
    assert made.stdout.startswith("s: 12 of 12 runs")
    again = evoframe("report", *study)
    assert again.returncode == 0
    assert contents(tmp_path / "s" / "report") == written


def test_rows_without_curves_are_compared_but_not_drawn_over_generations(
    evoframe: Evoframe, study: list[str], tmp_path: Path
) -> None:
    made = tmp_path / "s"
    for wanted, kept in (("part", "n=1"), ("all", "nothing")):
        there = tmp_path / wanted
        (there / "imported").mkdir(parents=True)
        shutil.copy(made / "study.toml", there)
        shutil.copy(made / "rows.csv", there / "imported")
        for folder in made.glob(f"*{kept}*"):
            shutil.copytree(folder, there / folder.name)
    assert evoframe("report", *study[:2], "part", "all").returncode == 0
    everything = contents(tmp_path / "part" / "report")
    assert {f"{name}.pdf" for name in NAMES} - set(everything) == {
        *("curves-score-n-2.pdf", "curves-fitness-n-2.pdf"),
    }
    drawn = [name for name in contents(tmp_path / "all" / "report") if name.startswith("curves")]
    assert drawn == []


def test_a_study_without_a_grid_has_one_group(evoframe: Evoframe, tmp_path: Path) -> None:
    (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
    (tmp_path / "grid.toml").write_text('extends = "toy.toml"\nruns = 2\n[grid]\n')
    assert evoframe("study", "-p", toys.__file__, "grid.toml", "--out", "s").returncode == 0
    made = evoframe("report", "-p", toys.__file__, "s")
    assert made.returncode == 0, made.stderr
    assert {"curves-score-s.pdf", "finals-fitness-s.pdf"} < set(contents(tmp_path / "s" / "report"))


def test_of_a_study_that_is_not_finished_says_so(
    evoframe: Evoframe, study: list[str], tmp_path: Path
) -> None:
    path = tmp_path / "s" / "study.toml"
    path.write_text(path.read_text().replace("runs = 3", "runs = 4"))
    told_of = evoframe("report", *study, "--correction", "none", "--out", "elsewhere")
    assert "12 of 16 runs" in told_of.stdout


@pytest.mark.parametrize(
    ("directory", "message"),
    [
        ("nowhere", "does not exist"),
        ("empty", "finished"),
    ],
)
def test_where_there_is_nothing_to_report_it_says_so(
    evoframe: Evoframe, study: list[str], tmp_path: Path, directory: str, message: str
) -> None:
    (tmp_path / "empty").mkdir()
    (tmp_path / "empty" / "study.toml").write_bytes((tmp_path / "s" / "study.toml").read_bytes())
    refused = evoframe("report", *study[:2], directory)
    assert refused.returncode == 2
    assert refused.stderr.startswith(f"Error: {directory}: ")
    assert message in refused.stderr


def test_a_run_has_a_report_too(evoframe: Evoframe, tmp_path: Path) -> None:
    made = evoframe("run", "quick", "--out", "r")
    assert made.returncode == 0, made.stderr
    shown = evoframe("report", "r")
    assert shown.returncode == 0, shown.stderr
    written = contents(tmp_path / "r" / "report")
    figures = ("curves", "champion-body", "champion-network-morphology", "champion-network-controller")
    assert set(written) == {
        *(f"{name}.{ending}" for name in figures for ending in ("pdf", "svg", "png")),
        *("summary.csv", "summary.tex", *ALWAYS),
        *VERIFIED,
    }
    assert shown.stdout.startswith("r: best pair ")
    assert "10 turns, 224 pairs; finished" in shown.stdout
    summary = {
        row["figure"]: row["value (mm)"]
        for row in csv.DictReader(written["summary.csv"].decode().splitlines())
    }
    assert float(summary["best pair"]) >= float(summary["pair of the fittest"])
    assert evoframe("report", "r").returncode == 0
    assert contents(tmp_path / "r" / "report") == written


def test_a_run_that_goes_on_is_reported_as_it_is(evoframe: Evoframe, tmp_path: Path) -> None:
    with started(tmp_path, "-v", "run", "quick", "--set", "run.generations=1000000", "--out", "r") as process:
        told(process, "turn ")
        shown = evoframe("report", "r")
    assert shown.returncode == 0, shown.stderr
    assert "not finished" in shown.stdout


def test_what_its_plugins_do_not_draw_is_left_out_and_said(evoframe: Evoframe, tmp_path: Path) -> None:
    (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
    plugin = ("-p", toys.__file__)
    assert evoframe("run", *plugin, "toy.toml", "--out", "r").returncode == 0
    assert evoframe("report", *plugin, "r").returncode == 0
    written = contents(tmp_path / "r" / "report")
    assert set(written) == {
        *("curves.pdf", "curves.svg", "curves.png", "summary.csv", "summary.tex", *ALWAYS),
    }
    assert b"simulator" in written["report.html"]


def test_what_was_measured_of_another_champion_is_not_shown(evoframe: Evoframe, tmp_path: Path) -> None:
    (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
    plugin = ("-p", toys.__file__)
    for seed in (1, 2):
        command = ("run", *plugin, "toy.toml", "--set", "simulator=toy-steered", "--seed", seed)
        assert evoframe(*command, "--out", f"r{seed}").returncode == 0
    measured = evoframe("robustness", *plugin, "r1", "--published", "--controllers", 10)
    assert measured.returncode == 0, measured.stderr
    assert evoframe("report", *plugin, "r1").returncode == 0
    report = contents(tmp_path / "r1" / "report")
    assert "violins.pdf" in report
    shutil.copytree(tmp_path / "r1" / "robustness", tmp_path / "r2" / "robustness")
    assert evoframe("report", *plugin, "r2").returncode == 0
    report = contents(tmp_path / "r2" / "report")
    assert "violins.pdf" not in report
    assert b"evoframe robustness r2 --force" in report["report.html"]


def test_what_an_earlier_report_had_is_removed_and_nothing_else(
    evoframe: Evoframe, study: list[str], tmp_path: Path
) -> None:
    (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
    assert evoframe("run", *study[:2], "toy.toml", "--out", "r").returncode == 0
    assert evoframe("report", *study[:2], "r", "--out", "afresh").returncode == 0
    assert evoframe("report", *study, "--out", "there").returncode == 0
    there = tmp_path / "there"
    (there / "mine.pdf").touch()
    (there / "ranking.csv").write_text("changed by somebody")
    (there / "ranking.tex").unlink()
    (there / "ranking.tex").symlink_to(there / "mine.pdf")
    refused = evoframe("report", *study[:2], "r", "--out", "there")
    assert (refused.returncode, refused.stderr.startswith("Error: there: ")) == (2, True)
    assert evoframe("report", *study[:2], "r", "--out", "there", "--force").returncode == 0
    found, wanted = contents(there), contents(tmp_path / "afresh")
    assert {name: found[name] for name in wanted} == wanted
    assert set(found) - set(wanted) == {"mine.pdf", "ranking.csv", "ranking.tex"}


def test_only_what_evoframe_wrote_of_the_same_run_is_renewed(evoframe: Evoframe, tmp_path: Path) -> None:
    (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
    plugin = ("-p", toys.__file__)
    for seed in (1, 2):
        run = ("run", *plugin, "toy.toml", "--seed", seed, "--out", f"r{seed}")
        assert evoframe(*run).returncode == 0
    (tmp_path / "there").mkdir()
    (tmp_path / "there" / "summary.csv").write_text("mine")
    refused = evoframe("report", *plugin, "r1", "--out", "there")
    assert refused.returncode == 2
    assert refused.stderr.startswith("Error: there/summary.csv: ")
    assert contents(tmp_path / "there") == {"summary.csv": b"mine"}
    assert evoframe("report", *plugin, "r1", "--out", "there", "--force").returncode == 0
    (tmp_path / "r1").rename(tmp_path / "moved")
    assert evoframe("report", *plugin, "moved", "--out", "there").returncode == 0
    before = contents(tmp_path / "there")
    refused = evoframe("report", *plugin, "r2", "--out", "there")
    assert refused.returncode == 2
    assert refused.stderr.startswith("Error: there: ")
    assert contents(tmp_path / "there") == before
    (tmp_path / "there" / "summary.csv").write_text("mine")
    refused = evoframe("report", *plugin, "moved", "--out", "there")
    assert refused.returncode == 2
    assert refused.stderr.startswith("Error: there/summary.csv: ")


def test_a_list_of_something_else_is_refused_before_anything_is_written(
    evoframe: Evoframe, tmp_path: Path
) -> None:
    (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
    assert evoframe("run", "-p", toys.__file__, "toy.toml", "--out", "r").returncode == 0
    (tmp_path / "there").mkdir()
    (tmp_path / "there" / "report.json").write_text("{}")
    refused = evoframe("report", "-p", toys.__file__, "r", "--out", "there")
    assert refused.returncode == 2
    assert refused.stderr.startswith("Error: there/report.json: ")
    assert contents(tmp_path / "there") == {"report.json": b"{}"}


def test_names_are_shown_as_they_are(evoframe: Evoframe, tmp_path: Path) -> None:
    (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
    plugin, name = ("-p", toys.__file__), "cost$^$ <b>&'\u00e9"
    assert evoframe("run", *plugin, "toy.toml", "--out", name).returncode == 0
    shown = evoframe("report", *plugin, name)
    assert shown.returncode == 0, shown.stderr
    page = (tmp_path / name / "report" / "report.html").read_text()
    assert "<h1>cost$^$ &lt;b&gt;&amp;&#39;\u00e9</h1>" in page


@pytest.mark.parametrize("name", ["config.toml", "study.toml", "robustness.json"])
def test_a_place_of_something_else_is_refused(
    evoframe: Evoframe, study: list[str], tmp_path: Path, name: str
) -> None:
    (tmp_path / "there").mkdir()
    (tmp_path / "there" / name).touch()
    refused = evoframe("report", *study, "--out", "there")
    assert refused.returncode == 2
    assert refused.stderr.startswith("Error: there: ")
    assert name in refused.stderr
    assert [path.name for path in (tmp_path / "there").iterdir()] == [name]


def test_a_name_that_no_directory_can_have_is_refused(evoframe: Evoframe) -> None:
    for command in ("report", "robustness"):
        refused = evoframe(command, "a" * 300)
        assert refused.returncode == 2
        assert "File name too long" in refused.stderr


def test_a_finished_run_without_its_champion_is_named(
    evoframe: Evoframe, study: list[str], tmp_path: Path
) -> None:
    [path, *_] = sorted((tmp_path / "s").glob("**/champion.json"))
    path.unlink()
    refused = evoframe("report", *study)
    assert refused.returncode == 2
    assert refused.stderr.startswith(f"Error: {path.relative_to(tmp_path)}: ")


def test_a_study_of_one_group_is_described(evoframe: Evoframe, tmp_path: Path) -> None:
    (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
    (tmp_path / "one.toml").write_text('extends = "toy.toml"\nruns = 2\n[grid]\n"collaboration.n" = [1]\n')
    plugin = ("-p", toys.__file__)
    assert evoframe("study", *plugin, "one.toml", "--out", "s").returncode == 0
    shown = evoframe("report", *plugin, "s")
    assert shown.returncode == 0, shown.stderr
    summary = list(csv.DictReader((tmp_path / "s" / "report" / "summary.csv").read_text().splitlines()))
    assert [(row["group"], row["runs"], row["yardstick"]) for row in summary] == [
        ("1", "2", "score"), ("1", "2", "fitness"),
    ]  # fmt: skip
    assert (tmp_path / "s" / "report" / "pairs.csv").read_text().startswith("view,yardstick,first,second")


def test_scores_of_another_kind_are_said_to_be(evoframe: Evoframe, tmp_path: Path) -> None:
    (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
    (tmp_path / "two.toml").write_text(
        'extends = "toy.toml"\nruns = 1\n[grid]\n'
        'simulator = ["toy-product", {name = "toy-varied", gain = 2.0}]\n'
    )
    plugin = ("-p", toys.__file__)
    assert evoframe("study", *plugin, "two.toml", "--out", "s").returncode == 0
    shown = evoframe("report", *plugin, "s")
    assert shown.returncode == 0, shown.stderr
    assert "simulate" in shown.stdout


def test_several_reports_are_written_each_in_its_place(evoframe: Evoframe, tmp_path: Path) -> None:
    (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
    plugin = ("-p", toys.__file__)
    for name in ("a", "b"):
        assert evoframe("run", *plugin, "toy.toml", "--out", name).returncode == 0
    assert evoframe("-q", "report", *plugin, "a", "b").stdout.splitlines() == ["a/report", "b/report"]
    refused = evoframe("report", *plugin, "a", "b", "--out", "c")
    assert refused.returncode == 2
    assert refused.stderr.startswith("Error: --out c: ")


def test_a_missing_package_is_named_with_its_command(study: list[str], tmp_path: Path) -> None:
    program = "import sys; sys.modules['matplotlib'] = None; from evoframe.cli import main; main()"
    refused = python("-c", program, "report", *study, directory=tmp_path)
    assert refused.returncode == 2
    assert "matplotlib" in refused.stderr
    assert "pip install '.[report]'" in refused.stderr
