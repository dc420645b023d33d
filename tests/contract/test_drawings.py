"""What is drawn: values that nobody changes, and that are compared where that has a meaning."""

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


def test_graphs_are_equal_where_all_their_parts_are() -> None:
    assert graph(0.5) == graph(0.5)
    assert graph(0.5) != graph(0.25)


def test_a_geometry_is_compared_by_who_it_is() -> None:
    """Its arrays have no one truth value; ``==`` must not raise that."""
    first, second = (Geometry(np.zeros(1), (part(),), {}) for _ in range(2))
    assert (first == first, first == second) == (True, False)  # noqa: PLR0124 - that is the question


@pytest.mark.parametrize(
    ("value", "field"),
    [
        (part(), "colour"),
        (Geometry(np.zeros(1), (), {}), "parts"),
        (graph(1.0), "labels"),
        (NetworkLink(0, 1, 1.0), "end"),
    ],
)
def test_nothing_that_is_drawn_can_be_changed(value: object, field: str) -> None:
    with pytest.raises(attrs.exceptions.FrozenInstanceError):
        setattr(value, field, None)
