"""Tests of ``load_study``: tidy tables of the finished runs."""

from __future__ import annotations

import shutil
from pathlib import Path

import polars as pl

from evoframe import Plugins, load_run, load_study
from evoframe.study.conduct import claim
from evoframe.study.plan import Planned, Study
from evoframe.study.rows import row_of


def test_an_unfinished_study_is_read_and_not_changed(
    made: tuple[Study, Path, list[Planned]], toy_plugins: Plugins, tmp_path: Path
) -> None:
    study, _, planned = made
    there = tmp_path / "there"
    claim(study, there)
    for run in planned[:3]:
        shutil.copytree(run.directory, there / run.cell.folder / "00")
    before = sorted(path for path in there.rglob("*") if path.is_file())
    data = load_study(there, plugins=toy_plugins)
    assert sorted(path for path in there.rglob("*") if path.is_file()) == before
    assert list(data.rows) == [row_of(run, load_run(run.directory)) for run in list(study.planned(there))[:3]]
    assert (data.label, data.planned, data.unit) == ("there", 4, "")
    assert data.keys == ("collaboration.n", "simulator")
    views = data.views("score")
    assert [view.title for view in views] == ["n = 1", "n = 2", "best of each"]
    assert list(views[1].groups) == ["toy-product"]
    frame = data.frame
    assert list(frame["score"]) == [row.score for row in data.rows]
    assert list(frame.columns[:4]) == ["collaboration.n", "simulator", "run", "seed"]
    assert list(frame.loc[frame["collaboration.n"] == 1, "run"]) == [0, 0]
    curves = data.curves
    assert len(curves) == 3 * 5
    last = curves[curves["generation"] == 4]
    assert list(last["fitness"]) == [row.fitness for row in data.rows]


def test_bit_generations_are_compared_between_runs(
    made: tuple[Study, Path, list[Planned]], toy_plugins: Plugins, tmp_path: Path
) -> None:
    study, directory, planned = made
    there = tmp_path / "there"
    claim(study, there)
    shutil.copytree(directory, there, dirs_exist_ok=True)
    assert load_study(there, plugins=toy_plugins).mixed == ()
    config = there / planned[0].directory.relative_to(directory) / "config.toml"
    changed = "[provenance]\nbit_generations = {aggregator = 2}\n"
    config.write_text(config.read_text().replace("[provenance]\n", changed))
    data = load_study(there, plugins=toy_plugins)
    assert data.mixed == ("aggregator 'toy-mean': 1 and 2",)
    assert list(data.frame["bit_generations"]) == ["aggregator=2", "", "", ""]


def test_polars_accepts_the_tables(
    made: tuple[Study, Path, list[Planned]], toy_plugins: Plugins, tmp_path: Path
) -> None:
    study, directory, _ = made
    claim(study, tmp_path / "there")
    shutil.copytree(directory, tmp_path / "there", dirs_exist_ok=True)
    data = load_study(tmp_path / "there", plugins=toy_plugins)
    for table in (data.frame, data.curves):
        taken = pl.from_dataframe(table)
        assert taken.columns == list(table.columns)
        assert taken["score"].to_list() == list(table["score"])
        assert taken["collaboration.n"].dtype == pl.Int64
