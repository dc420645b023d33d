"""Tests of figures of bodies: parts, colors, texts and layout."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from matplotlib.colors import to_rgb
from matplotlib.transforms import Bbox
from mpl_toolkits.mplot3d import proj3d
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

from evoframe import Design, Geometry
from evoframe.analysis.figures.bodies import body
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


def test_all_faces_have_shades_of_their_color(geometry: Geometry) -> None:
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
    assert shown[1].replace("\u2009", "") == "250\u00d7200\u00d7200 mm"


def extent_of(figure: Any, points: Any) -> Bbox:
    """Return the extent of points of the body in the figure, in pixels."""
    [axes] = figure.axes
    x, y, _ = proj3d.proj_transform(*points.T, axes.get_proj())
    shown = axes.transData.transform(np.column_stack([x, y]))
    return Bbox([shown.min(axis=0), shown.max(axis=0)])


@settings(max_examples=10)
@given(shape=st.tuples(*[st.integers(1, 12)] * 3))
def test_a_body_of_any_shape_overlaps_nothing_and_is_not_clipped(shape: tuple[int, int, int]) -> None:
    design = Design({"morphology": np.ones(shape, np.uint8), "controller": np.zeros(shape)})
    geometry = Vox().geometry(design, 2)
    figure = body(geometry, "a body")
    figure.draw_without_rendering()
    shown = extent_of(figure, np.concatenate([part.vertices[0] for part in geometry.parts]))
    [legend], [axes] = figure.legends, figure.axes
    title, size = [text.get_window_extent() for text in figure.texts]
    letters = [extent_of(figure, np.array([text.get_position_3d()])).padded(4) for text in axes.texts]  # type: ignore[attr-defined]
    assert len(letters) == 3
    assert not any(other.overlaps(shown) for other in (title, size, legend.get_window_extent()))
    assert not title.overlaps(size)
    for box in (shown, title, size, *letters):
        assert min(box.x0, box.y0) >= 0
        assert box.x1 <= figure.bbox.x1
        assert box.y1 <= figure.bbox.y1
    assert (
        shown.width > 0.5 * figure.bbox.width or shown.height > 1.5 * figure.dpi
    )  # the body fills the figure


def test_a_later_frame_changes_the_figure(geometry: Geometry) -> None:
    rest, later = (body(geometry, frame=frame).axes[0].get_xlim() for frame in (0, 1))
    assert rest == (0.0, 0.25)
    assert rest != later
