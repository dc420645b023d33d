"""Tests of the section of a report on a measurement of its champions."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
import toy_box
import toys

from evoframe import Plugins, Run, measure_robustness, run
from evoframe.analysis.page.html import Picture, Words
from evoframe.analysis.robustness import find, robustness_part, write_robustness


@pytest.fixture
def plugins() -> Plugins:
    return toy_box.installed()


@pytest.fixture
def measured(plugins: Plugins, tmp_path: Path) -> Run:
    """Return a run whose champion was measured."""
    (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
    made = run(tmp_path / "toy.toml", simulator="toy-steered", out=tmp_path / "r", plugins=plugins)
    found = find(measure_robustness(made, published=True, controllers=5, plugins=plugins))
    write_robustness(found, made.directory / "robustness")
    return made


def test_without_a_measurement_there_is_no_section(plugins: Plugins, tmp_path: Path) -> None:
    part = robustness_part(tmp_path, plugins)
    assert (part.sections, part.files) == ((), {})


def test_figure_and_conclusions_of_a_measurement_are_shown(plugins: Plugins, measured: Run) -> None:
    part = robustness_part(measured.directory, plugins, "none")
    [section] = part.sections
    picture, *words = section.blocks
    assert isinstance(picture, Picture)
    assert picture.svg == part.files["violins.svg"]
    assert {*part.files} == {f"violins.{ending}" for ending in ("pdf", "svg", "png")}
    assert all(isinstance(block, Words) and block.text for block in words)
    assert any("no correction" in block.text for block in words if isinstance(block, Words))


def test_a_measurement_of_another_champion_is_not_shown(
    plugins: Plugins, measured: Run, tmp_path: Path
) -> None:
    other = run(tmp_path / "toy.toml", simulator="toy-steered", seed=2, out=tmp_path / "o", plugins=plugins)
    shutil.copytree(measured.directory / "robustness", other.directory / "robustness")
    part = robustness_part(other.directory, plugins)
    [section] = part.sections
    [words] = section.blocks
    assert isinstance(words, Words)
    assert words.text.endswith("evoframe robustness o --force")
    assert part.files == {}
