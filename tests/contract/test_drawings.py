"""Tests of drawable values: they are frozen, and graphs are compared by value."""

from __future__ import annotations

import attrs
import numpy as np
import pytest

from evoframe import Geometry, GeometryPart, NetworkGraph, NetworkLink


def graph(weight: float) -> NetworkGraph:
    return NetworkGraph((-1, -2), (0,), {0: "sin"}, (NetworkLink(-1, 0, weight),))


def part() -> GeometryPart:
    square = np.array([[[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]])
    return GeometryPart("contractile", "#cc3311", 1.0, square, np.array([[0, 1, 2, 3]]))


def test_graphs_are_equal_if_all_their_parts_are() -> None:
    assert graph(0.5) == graph(0.5)
    assert graph(0.5) != graph(0.25)


def test_geometries_are_compared_by_identity() -> None:
    """Comparing their arrays has no single truth value; ``==`` must not raise."""
    first, second = (Geometry(np.zeros(1), (part(),), {}) for _ in range(2))
    assert (first == first, first == second) == (True, False)  # noqa: PLR0124 - tests identity


@pytest.mark.parametrize(
    ("value", "field"),
    [
        (part(), "colour"),
        (Geometry(np.zeros(1), (), {}), "parts"),
        (graph(1.0), "labels"),
        (NetworkLink(0, 1, 1.0), "end"),
    ],
)
def test_drawable_values_cannot_be_changed(value: object, field: str) -> None:
    with pytest.raises(attrs.exceptions.FrozenInstanceError):
        setattr(value, field, None)
