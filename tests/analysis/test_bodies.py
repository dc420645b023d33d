"""Figures of bodies show all their parts, in the colours that were asked for."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

from evoframe import Design, Geometry
from evoframe.analysis.bodies import body
from evoframe_simulators import Vox


@pytest.fixture(scope="module")
def geometry() -> Geometry:
    material = np.ones((5, 4, 4), np.uint8)
    material[1:-1, 1:-1, 1:-1] = 3
    return Vox().geometry(Design({"morphology": material, "controller": np.zeros(material.shape)}), 2)


def collection(figure: Any) -> Poly3DCollection:
    [axes] = figure.axes
    [found] = [each for each in axes.collections if len(each.get_facecolor()) > 1]
    return found


def test_all_faces_are_there_in_shades_of_their_colour(geometry: Geometry) -> None:
    drawn = collection(body(geometry, "a body"))
    colours = np.asarray(drawn.get_facecolor())
    assert len(colours) == sum(len(part.faces) for part in geometry.parts)
    for part in geometry.parts:
        of_part = colours[colours[:, 3] == part.opacity]
        assert len(of_part) == len(part.faces)
        shades = of_part[:, :3] / np.maximum(to_rgb(part.colour), 1e-12)
        visible = np.array(to_rgb(part.colour)) > 0
        assert shades[:, visible].min() > 0.5
        assert shades[:, visible].max() <= 1.0


def test_parts_title_and_size_are_named(geometry: Geometry) -> None:
    figure = body(geometry, "a body")
    [legend] = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == ["contractile", "enclosure"]
    shown = [text.get_text() for text in figure.texts]
    assert shown[0] == "a body"
    assert shown[1].replace("\u2009", "") == "0.25\u00d70.2\u00d70.2 m"


def test_a_later_frame_is_another_picture(geometry: Geometry) -> None:
    rest, later = (body(geometry, frame=frame).axes[0].get_xlim() for frame in (0, 1))
    assert rest == (0.0, 0.25)
    assert rest != later
