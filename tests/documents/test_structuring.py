"""Where a fault is, in tables within tables."""

from __future__ import annotations

from typing import Any

import attrs
import pytest

from evoframe.documents.structuring import StructureError, structure


@attrs.frozen
class Wheel:
    radius: float
    spokes: int = 32


@attrs.frozen
class Cart:
    front: Wheel
    others: tuple[Wheel, ...] = ()


@pytest.mark.parametrize(
    ("table", "places"),
    [
        ({}, ["cart.front"]),
        ({"front": {}}, ["cart.front.radius"]),
        ({"front": {"radius": 1, "spoke": 3}}, ["cart.front.spoke"]),
        ({"front": {"radius": 1}, "others": [{"radius": 2}, {}]}, ["cart.others[1].radius"]),
        ({"front": {"radius": "a"}, "others": [{}]}, ["cart.front.radius", "cart.others[0].radius"]),
    ],
)
def test_a_fault_has_its_place(table: Any, places: list[str]) -> None:
    with pytest.raises(StructureError) as refused:
        structure(table, Cart, ("cart",))
    assert [".".join(fault.path) for fault in refused.value.faults] == places
