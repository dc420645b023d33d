"""Tests of the loading of a champion."""

from __future__ import annotations

from pathlib import Path

import pytest
import toy_box
import toys

from evoframe import InputError, run
from evoframe.analysis.data.champions import load_champion
from evoframe.registry.discovery import discover


def test_it_has_the_score_and_the_verification_of_its_run(tmp_path: Path) -> None:
    made = run("quick", out=tmp_path / "r", run={"generations": 1})
    data = load_champion(made, discover())
    assert (data.score, data.unit) == (made.champion().score, "m")
    assert data.verification == made.verification()
    assert data.geometry is not None
    assert data.track in data.geometry.tracks
    assert [each.population for each in data.networks] == ["morphology", "controller"]
    assert all(len(each.inputs) == len(each.graph.inputs) for each in data.networks)


def test_plugins_without_geometries_and_graphs_give_none(tmp_path: Path) -> None:
    (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
    plugins = toy_box.installed()
    data = load_champion(run(tmp_path / "toy.toml", out=tmp_path / "r", plugins=plugins), plugins)
    assert (data.geometry, data.track, data.networks) == (None, None, ())


def test_a_damaged_genome_is_reported_with_run_and_population(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    made = run("quick", out=tmp_path / "r", run={"generations": 1})
    plugins = discover()

    def refused(*_: object) -> None:
        raise ValueError("no network")

    monkeypatch.setattr(plugins.find("evolver", "neat").component, "graph", refused)
    with pytest.raises(InputError, match="no network") as caught:
        load_champion(made, plugins)
    assert (caught.value.source, caught.value.key) == (str(made.directory), "morphology")
