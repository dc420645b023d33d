"""Tests of the report of a run."""

from __future__ import annotations

import csv
from collections.abc import Callable
from pathlib import Path

import pytest
import toy_box
import toys

from evoframe import Plugins, Run, RunConfig, run
from evoframe.analysis.page.html import Source, Table
from evoframe.analysis.report.run_report import draft_of_run


@pytest.fixture
def plugins() -> Plugins:
    return toy_box.installed()


@pytest.fixture
def made(plugins: Plugins, tmp_path: Path) -> Run:
    """Return a run of toys."""
    (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
    return run(tmp_path / "toy.toml", out=tmp_path / "r", plugins=plugins)


def test_the_summary_has_the_recorded_results(made: Run, plugins: Plugins) -> None:
    draft = draft_of_run(made, plugins)
    rows = csv.DictReader(draft.files["summary.csv"].decode().splitlines())
    figures = {row["figure"]: float(row["value"]) for row in rows}
    last = {row["population"]: row for row in made.turns()}
    assert figures == {
        "best pair": made.champion().score,
        **{f"{name}: {what} fitness": row[what] for name, row in last.items() for what in ("best", "mean")},
        "pair of the fittest": made.summary()["fittest_pair_score"],
    }


def test_the_printed_text_counts_turns_and_pairs(made: Run, plugins: Plugins) -> None:
    draft = draft_of_run(made, plugins)
    pairs = sum(row["pairs"] for row in made.workload())
    assert draft.words == f"r: {draft.lead}\n"
    assert draft.lead.endswith(f"; {made.last_turn():,} turns, {pairs:,} pairs; finished")


def test_the_page_starts_with_the_champion_and_ends_with_the_configuration(
    made: Run, plugins: Plugins
) -> None:
    first, *_, last = draft_of_run(made, plugins).sections
    assert (first.title, last.title) == ("Champion", "Configuration")
    source, versions = last.blocks
    assert isinstance(source, Source)
    assert source.text == (made.directory / "config.toml").read_text()
    assert isinstance(versions, Table)


@pytest.mark.parametrize(
    "name", ["one", "three archive", "parallel", "weighted", "measures", "roles in turns"]
)
def test_runs_with_any_timing_and_number_of_populations_have_a_report(
    toy_variant: Callable[..., RunConfig], plugins: Plugins, tmp_path: Path, name: str
) -> None:
    config = toy_variant(name)
    finished = run(config, out=tmp_path / "r", plugins=plugins)
    draft = draft_of_run(finished, plugins)
    rows = csv.DictReader(draft.files["summary.csv"].decode().splitlines())
    figures = {row["figure"]: float(row["value"]) for row in rows}
    assert figures["best pair"] == finished.champion().score
    assert {f"{name}: best fitness" for name in config.populations} <= figures.keys()
    assert f"{finished.last_turn():,} turns" in draft.lead
