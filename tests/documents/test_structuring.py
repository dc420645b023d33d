"""Where a fault is, in tables within tables."""

from __future__ import annotations

from typing import Any, Literal

import attrs
import numpy as np
import pytest
from hypothesis import given, strategies as st

from evoframe.documents.structuring import StructureError, structure, unstructure


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


wheels = st.builds(Wheel, radius=st.floats(allow_nan=False, allow_infinity=False), spokes=st.integers())
carts = st.builds(Cart, front=wheels, others=st.lists(wheels, max_size=3).map(tuple))


@given(carts)
def test_what_was_written_as_tables_is_structured_to_the_same(cart: Cart) -> None:
    assert structure(unstructure(cart), Cart, ("cart",)) == cart


@attrs.frozen
class Load:
    name: str
    sort: Literal["grain", "coal"] = "grain"
    heavy: bool = False
    sizes: tuple[int, int] | None = None
    weight: float = attrs.field(default=1.0, validator=attrs.validators.gt(0))


@pytest.mark.parametrize(
    ("table", "message"),
    [
        ({}, "load.name: is missing"),
        ({"name": 3}, "load.name: expected a string, found 3"),
        ({"name": "a", "heavy": 1}, "load.heavy: expected true or false, found 1"),
        ({"name": "a", "sort": "cole"}, 'load.sort: expected one of "grain", "coal", found "cole"'),
        ({"name": "a", "sizes": [1]}, "load.sizes: expected a list of 2, found [1]"),
        ({"name": "a", "sizes": [1, True]}, "load.sizes[1]: expected a whole number, found true"),
        ({"name": "a", "weight": 0}, "load.weight: must be > 0, found 0.0"),
        ({"name": "a", "weight": float("nan")}, "load.weight: expected a finite number, found nan"),
        (
            {"name": "a", "wieght": 2},
            "load.wieght: unknown option; did you mean 'weight'? options: name, sort",
        ),
        (3, "load: expected a table, found 3"),
    ],
)
def test_a_fault_says_what_was_found_and_what_was_expected(table: Any, message: str) -> None:
    with pytest.raises(StructureError) as refused:
        structure(table, Load, ("load",))
    assert str(refused.value).startswith(message)


def test_numbers_of_numpy_are_numbers_and_none_is_left_out() -> None:
    load = structure({"name": "a", "sizes": np.array([1, 2]), "weight": np.float32(2.5)}, Load, ("load",))
    assert load == Load("a", sizes=(1, 2), weight=2.5)
    assert unstructure(Load("a")) == {"name": "a", "sort": "grain", "heavy": False, "weight": 1.0}
