"""Geometry of voxel bodies for figures and pages."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from numpy.typing import NDArray

from evoframe import Design, Geometry, GeometryPart, InputError
from evoframe_simulators import PaletteMaterial, Vox

SIZE = Vox().voxel_size


def design(material: NDArray[np.uint8]) -> Design:
    return Design({"morphology": material, "controller": np.full(material.shape, 0.25)})


def bar(canvas: tuple[int, int, int] = (6, 4, 4)) -> NDArray[np.uint8]:
    """A contractile bar in a passive enclosure."""
    material = np.ones(canvas, np.uint8)
    material[1:-1, 1:-1, 1:-1] = 3
    return material


def named(geometry: Geometry) -> dict[str, GeometryPart]:
    return {part.name: part for part in geometry.parts}


def volume(part: GeometryPart, frame: int = 0) -> float:
    """Return the enclosed volume in voxels (divergence theorem); correct only if all faces face outwards."""
    corners = part.vertices[frame][part.faces]
    areas = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]) / 2
    return float((corners.mean(axis=1) * areas).sum() / 3 / SIZE**3)


bodies = st.integers(0, 2**32 - 1).map(
    lambda seed: np.random.default_rng(seed).choice(np.array([0, 0, 1, 3], np.uint8), (4, 3, 3))
)


@settings(max_examples=25, deadline=None)
@given(bodies.filter(lambda body: bool(np.any(body == 3))))
def test_the_faces_of_all_parts_enclose_the_volume_of_the_voxels(body: NDArray[np.uint8]) -> None:
    geometry = Vox().geometry(design(body), 1)
    total = sum(volume(part) for part in geometry.parts)
    assert total == pytest.approx(np.count_nonzero(body))


@settings(max_examples=25, deadline=None)
@given(bodies.filter(lambda body: bool(np.any(body))))
def test_each_exposed_face_is_drawn_once(body: NDArray[np.uint8]) -> None:
    present = np.pad(body != 0, 1).astype(int)
    exposed = sum(int(np.abs(np.diff(present, axis=axis)).sum()) for axis in range(3))
    faces = [part.vertices[0][part.faces].mean(axis=1) for part in Vox().geometry(design(body), 1).parts]
    centers = np.concatenate(faces)
    assert len(centers) == exposed == len(np.unique(centers.round(9), axis=0))


def test_the_enclosure_is_a_separate_translucent_part() -> None:
    parts = named(Vox().geometry(design(bar()), 1))
    assert list(parts) == ["contractile", "enclosure"]
    assert parts["contractile"].opacity == 1.0
    assert parts["enclosure"].opacity < 0.5
    assert volume(parts["enclosure"]) == pytest.approx(6 * 4 * 4)
    assert volume(parts["contractile"]) == pytest.approx(4 * 2 * 2)


def test_a_layer_with_a_hole_encloses_nothing() -> None:
    body = bar()
    body[0, 0, 0] = 0
    assert list(named(Vox().geometry(design(body), 1))) == ["passive"]  # hides the contractile voxels


def test_contractile_parts_are_red_and_passive_ones_blue() -> None:
    body = np.array([[[1]], [[3]]], np.uint8)
    colors = {name: part.colour for name, part in named(Vox().geometry(design(body), 1)).items()}
    assert colors == {"passive": "#0077BB", "contractile": "#CC3311"}


def test_materials_of_a_palette_have_distinct_colors() -> None:
    palette = tuple(
        PaletteMaterial(code, 5e6, 0.35, 1e6, expansion, name=name)
        for code, expansion, name in ((1, 0.0, "soft"), (2, 0.0, ""), (3, 0.01, "muscle"), (4, -0.01, ""))
    )
    body = np.array([1, 2, 3, 4], np.uint8).reshape(4, 1, 1)
    parts = named(Vox(palette=palette).geometry(design(body), 1))
    assert list(parts) == ["soft", "material 2", "muscle", "material 4"]
    assert len({part.colour for part in parts.values()}) == 4


def test_frames_are_spread_from_the_start_to_the_end() -> None:
    geometry = Vox().geometry(design(bar()), 5)
    step = geometry.times[-1] / 22  # the paper's 22 steps
    assert (geometry.times / step).round(9).tolist() == [0, 6, 11, 16, 22]  # halves are rounded to even
    assert len(Vox().geometry(design(bar()), 100).times) == 23


def test_the_tracks_come_from_the_simulation() -> None:
    geometry = Vox().geometry(design(bar()), 3)
    assert set(geometry.tracks) == {"tip", "face", "body"}
    assert geometry.tracks["tip"][0] == pytest.approx((np.array([6, 4, 4]) - 0.5) * SIZE)


def test_clamped_faces_do_not_move_and_contractile_parts_grow() -> None:
    geometry = Vox().geometry(design(bar()), 3)
    parts = named(geometry)
    enclosure = parts["enclosure"].vertices
    clamped = enclosure[0, :, 0] == 0.0
    assert np.array_equal(enclosure[0][clamped], enclosure[-1][clamped])
    assert np.ptp(enclosure[-1, :, 0]) > np.ptp(enclosure[0, :, 0])


def test_corners_move_by_the_mean_of_their_voxels() -> None:
    two = np.array([[[1]], [[3]]], np.uint8)
    geometry = Vox().geometry(design(two), 2)
    shift = geometry.tracks["tip"][1] - geometry.tracks["tip"][0]
    part = named(geometry)["contractile"]
    moved = part.vertices[1] - part.vertices[0]
    between = np.isclose(part.vertices[0, :, 0], SIZE)
    assert moved[~between] == pytest.approx(np.broadcast_to(shift, (4, 3)))
    assert moved[between] == pytest.approx(np.broadcast_to(shift / 2, (4, 3)))


def test_a_diverging_simulation_is_drawn_up_to_the_divergence() -> None:
    geometry = Vox(largest_strain=1e-3).geometry(design(bar()), 23)
    assert 1 < len(geometry.times) < 23
    assert all(np.isfinite(part.vertices).all() for part in geometry.parts)


def test_a_body_without_voxels_is_rejected() -> None:
    with pytest.raises(InputError, match="no voxels") as caught:
        Vox().geometry(design(np.zeros((2, 2, 2), np.uint8)), 1)
    assert caught.value.key == "morphology"


def test_an_unknown_code_is_rejected() -> None:
    with pytest.raises(InputError, match="code 7"):
        Vox().geometry(design(np.full((2, 2, 2), 7, np.uint8)), 1)


def test_a_geometry_without_frames_is_rejected() -> None:
    with pytest.raises(ValueError, match="found 0"):
        Vox().geometry(design(bar()), 0)
