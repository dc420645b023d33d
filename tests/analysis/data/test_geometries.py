"""Tests of the validation of geometries returned by simulators."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import attrs
import numpy as np
import pytest
import toy_box
import toys

from evoframe import Design, Geometry, GeometryPart, run
from evoframe.analysis.data.champions import load_champion
from evoframe.analysis.data.geometries import validate_geometry
from evoframe.errors import ComponentError

VERTICES = np.array([[[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]] * 2, np.float64)
SQUARE = GeometryPart("square", "#CC3311", 1.0, VERTICES, np.array([[0, 1, 2, 3]]))
GOOD = Geometry(np.array([0.0, 1.0]), (SQUARE,), {"tip": VERTICES[:, 2]})


def with_part(**changes: Any) -> Geometry:
    return attrs.evolve(GOOD, parts=(attrs.evolve(SQUARE, **changes),))


def test_a_valid_geometry_is_returned() -> None:
    assert validate_geometry(GOOD) is GOOD


@pytest.mark.parametrize(
    ("given", "problem"),
    [
        (None, "NoneType"),
        (attrs.evolve(GOOD, parts=()), "no visible"),
        (with_part(vertices=VERTICES * np.nan), r"vertices of 'square' .*1e\+30"),
        (with_part(vertices=VERTICES * 1e300), r"vertices of 'square' .*1e\+30"),
        (with_part(vertices=VERTICES[:1]), r"'square'.* \(1, 4, 3\), expected \(2, 4, 3\)"),
        (with_part(vertices=VERTICES[0]), r"'square'.* \(4, 3\), expected \(2, 0, 3\)"),
        (with_part(faces=np.array([[0, 1, 2]])), r"faces of 'square' as int64\(1, 3\)"),
        (with_part(faces=np.array([[0.0, 1.0, 2.0, 3.0]])), r"faces of 'square' as float64\(1, 4\)"),
        (with_part(faces=np.array([[0, 1, 2, 4]])), "vertices 0 to 4, expected 0 to 3"),
        (with_part(faces=np.array([[0, 1, 2, -1]])), "vertices -1 to 2, expected 0 to 3"),
        (with_part(colour="reddish"), "'square' .*'reddish'"),
        (with_part(opacity=np.nan), "opacity nan"),
        (attrs.evolve(GOOD, times=np.array([0.0, np.inf])), r"times .*1e\+30"),
        (attrs.evolve(GOOD, times=np.array([])), r"times .*\(0,\)"),
        (attrs.evolve(GOOD, tracks={"tip": VERTICES[:1, 2]}), r"track 'tip' .*\(1, 3\), expected \(2, 3\)"),
        (attrs.evolve(GOOD, tracks={"tip": np.full((2, 3), np.nan)}), r"track 'tip' .*1e\+30"),
    ],
)
def test_an_invalid_geometry_is_named(given: Any, problem: str) -> None:
    with pytest.raises((TypeError, ValueError), match=problem):
        validate_geometry(given)


def test_the_error_names_the_simulator(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
    plugins = toy_box.installed()
    made = run(tmp_path / "toy.toml", out=tmp_path / "r", plugins=plugins)

    def geometry(_: toys.Product, design: Design, frames: int) -> Geometry:
        return with_part(vertices=VERTICES * np.nan)

    monkeypatch.setattr(toys.Product, "geometry", geometry, raising=False)
    with pytest.raises(ComponentError, match=r"ValueError: .*vertices of 'square'") as caught:
        load_champion(made, plugins)
    assert caught.value.component == "simulator"
