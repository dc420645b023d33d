"""A geometry that cannot be drawn is the fault of the simulator that gave it."""

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
from evoframe.analysis.data.geometries import checked
from evoframe.errors import ComponentError

VERTICES = np.array([[[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]] * 2, np.float64)
SQUARE = GeometryPart("square", "#CC3311", 1.0, VERTICES, np.array([[0, 1, 2, 3]]))
GOOD = Geometry(np.array([0.0, 1.0]), (SQUARE,), {"tip": VERTICES[:, 2]})


def with_part(**changes: Any) -> Geometry:
    return attrs.evolve(GOOD, parts=(attrs.evolve(SQUARE, **changes),))


def test_what_can_be_drawn_is_returned_as_it_is() -> None:
    assert checked(GOOD) is GOOD


@pytest.mark.parametrize(
    ("given", "problem"),
    [
        (None, "gave NoneType, expected a Geometry"),
        (attrs.evolve(GOOD, parts=()), "gave nothing that can be seen"),
        (with_part(vertices=VERTICES * np.nan), "gave vertices of 'square' that are not finite"),
        (with_part(vertices=VERTICES * 1e300), "gave vertices of 'square' that are not finite, or larger"),
        (with_part(vertices=VERTICES[:1]), r"of shape \(1, 4, 3\), expected \(2, 4, 3\)"),
        (with_part(vertices=VERTICES[0]), r"of shape \(4, 3\), expected \(2, 0, 3\)"),
        (with_part(faces=np.array([[0, 1, 2]])), r"faces of 'square' that are no integers of shape \(m, 4\)"),
        (with_part(faces=np.array([[0.0, 1.0, 2.0, 3.0]])), "faces of 'square' that are no integers"),
        (with_part(faces=np.array([[0, 1, 2, 4]])), "other corners than its 4 vertices"),
        (with_part(faces=np.array([[0, 1, 2, -1]])), "other corners than its 4 vertices"),
        (with_part(colour="reddish"), "gave 'square' the colour 'reddish'"),
        (with_part(opacity=np.nan), "opacity nan"),
        (attrs.evolve(GOOD, times=np.array([0.0, np.inf])), "gave times that are not finite"),
        (attrs.evolve(GOOD, times=np.array([])), r"gave times of shape \(0,\)"),
        (attrs.evolve(GOOD, tracks={"tip": VERTICES[:1, 2]}), "gave the track 'tip' of shape"),
        (attrs.evolve(GOOD, tracks={"tip": np.full((2, 3), np.nan)}), "gave the track 'tip' that are not"),
    ],
)
def test_what_cannot_be_drawn_is_named(given: Any, problem: str) -> None:
    with pytest.raises((TypeError, ValueError), match=problem):
        checked(given)


def test_the_simulator_is_blamed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
    plugins = toy_box.installed()
    made = run(tmp_path / "toy.toml", out=tmp_path / "r", plugins=plugins)

    def geometry(_: toys.Product, design: Design, frames: int) -> Geometry:
        return with_part(vertices=VERTICES * np.nan)

    monkeypatch.setattr(toys.Product, "geometry", geometry, raising=False)
    with pytest.raises(ComponentError, match=r"^simulator: ValueError: geometry\(\) gave vertices"):
        load_champion(made, plugins)
