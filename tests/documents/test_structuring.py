"""Tests of structuring: the place of each fault, in nested tables, and its message."""

from __future__ import annotations

from typing import Any, Generic, Literal, TypeVar

import attrs
import numpy as np
import pytest
from hypothesis import given, strategies as st

from evoframe.documents.structuring import StructureError, option_names, structure, unstructure

T = TypeVar("T")


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
def test_a_fault_has_the_path_of_its_value(table: Any, places: list[str]) -> None:
    with pytest.raises(StructureError) as refused:
        structure(table, Cart, ("cart",))
    assert [".".join(fault.path) for fault in refused.value.faults] == places


wheels = st.builds(Wheel, radius=st.floats(allow_nan=False, allow_infinity=False), spokes=st.integers())
carts = st.builds(Cart, front=wheels, others=st.lists(wheels, max_size=3).map(tuple))


@given(carts)
def test_unstructured_values_are_structured_to_the_same(cart: Cart) -> None:
    assert structure(unstructure(cart), Cart, ("cart",)) == cart


@attrs.frozen
class Harness(Generic[T]):
    name: str
    wheel: T

    def as_table(self) -> dict[str, Any]:
        return {"name": self.name, **unstructure(self.wheel)}


@attrs.frozen
class Pulled:
    by: Harness[Wheel]
    more: tuple[Harness[Wheel], ...] = ()


@attrs.frozen
class Load:
    name: str
    sort: Literal["grain", "coal"] = "grain"
    heavy: bool = False
    sizes: tuple[int, int] | None = None
    weight: float = attrs.field(default=1.0, validator=attrs.validators.gt(0))


@pytest.mark.parametrize(
    ("table", "path", "parts"),
    [
        ({}, "load.name", ["missing"]),
        ({"name": 3}, "load.name", ["a string", "found 3"]),
        ({"name": "a", "heavy": 1}, "load.heavy", ["true", "false", "found 1"]),
        ({"name": "a", "sort": "cole"}, "load.sort", ['"grain", "coal"', 'found "cole"']),
        ({"name": "a", "sizes": [1]}, "load.sizes", ["list of 2", "found [1]"]),
        ({"name": "a", "sizes": [1, True]}, "load.sizes[1]", ["whole number", "found true"]),
        ({"name": "a", "weight": 0}, "load.weight", ["> 0", "found 0.0"]),
        ({"name": "a", "weight": float("nan")}, "load.weight", ["finite number", "found nan"]),
        ({"name": "a", "wieght": 2}, "load.wieght", ["unknown option", "'weight'", "name, sort"]),
        (3, "load", ["a table", "found 3"]),
    ],
)
def test_a_fault_has_the_value_found_and_the_value_expected(table: Any, path: str, parts: list[str]) -> None:
    with pytest.raises(StructureError) as refused:
        structure(table, Load, ("load",))
    [fault] = refused.value.faults
    assert ".".join(fault.path) == path
    assert all(part in fault.message for part in parts)
    assert str(refused.value) == f"{path}: {fault.message}"


def test_only_an_unknown_option_lists_the_valid_ones() -> None:
    with pytest.raises(StructureError) as refused:
        structure({"name": 3, "wieght": 2}, Load, ("load",))
    assert [(fault.path[-1], fault.options) for fault in refused.value.faults] == [
        ("name", None),
        ("wieght", ("name", "sort", "heavy", "sizes", "weight")),
    ]


@attrs.frozen
class Train:
    load: Load
    cart: Cart
    length: int = attrs.field(init=False, default=1)


@attrs.frozen
class Unresolvable:
    load: Unknown  # type: ignore[name-defined]  # noqa: F821
    size: int


def test_options_of_nested_classes_have_dotted_names() -> None:
    loads = ["name", "sort", "heavy", "sizes", "weight"]
    nested = [f"load.{name}" for name in loads]
    expected = [
        "load",
        *nested,
        "cart",
        "cart.front",
        "cart.front.radius",
        "cart.front.spokes",
        "cart.others",
    ]
    assert list(option_names(Train)) == expected
    assert list(option_names(Unresolvable)) == ["load", "size"]


def test_numpy_numbers_are_accepted_and_none_is_left_out() -> None:
    load = structure({"name": "a", "sizes": np.array([1, 2]), "weight": np.float32(2.5)}, Load, ("load",))
    assert load == Load("a", sizes=(1, 2), weight=2.5)
    assert unstructure(Load("a")) == {"name": "a", "sort": "grain", "heavy": False, "weight": 1.0}


@attrs.frozen
class Ticket:
    seats: tuple[int, ...] | Literal["window", "aisle"] | None = None
    price: float | Literal["free"] = "free"
    load: tuple[int, int] | Load | str = ""


@pytest.mark.parametrize(
    "ticket",
    [
        Ticket(),
        Ticket(seats=()),
        Ticket(seats=(1, 2), price=3.5, load="coal"),
        Ticket(seats="aisle", price="free", load=Load("coal")),
        Ticket(load=(1, 2)),
    ],
    ids=str,
)
def test_an_option_can_have_one_of_several_types(ticket: Ticket) -> None:
    assert structure(unstructure(ticket), Ticket, ("ticket",)) == ticket


def test_one_of_several_types_can_be_none() -> None:
    assert structure({"seats": None}, Ticket, ("ticket",)) == Ticket()
    with pytest.raises(StructureError, match="found null"):
        structure({"price": None}, Ticket, ("ticket",))


@pytest.mark.parametrize(
    ("table", "path", "message"),
    [
        ({"seats": 3}, "ticket.seats", 'expected a list or one of "window", "aisle", found 3'),
        ({"seats": "roof"}, "ticket.seats", 'expected a list or one of "window", "aisle", found "roof"'),
        ({"seats": [1, 2.5]}, "ticket.seats[1]", "expected a whole number, found 2.5"),
        ({"price": True}, "ticket.price", 'expected a number or one of "free", found true'),
        ({"load": 3}, "ticket.load", "expected a list or a table or a string, found 3"),
        ({"load": [1, 2, 3]}, "ticket.load", "expected a list or a table or a string, found [1, 2, 3]"),
        ({"load": {}}, "ticket.load.name", "is missing"),
    ],
)
def test_a_fault_names_all_types_or_the_place_inside(table: Any, path: str, message: str) -> None:
    with pytest.raises(StructureError) as refused:
        structure(table, Ticket, ("ticket",))
    [fault] = refused.value.faults
    assert (".".join(fault.path), fault.message) == (path, message)


class TestValuesOfOthers:
    """Instances of generic classes, which are created elsewhere, and which write themselves."""

    cart = Pulled(Harness("rope", Wheel(1.0)), (Harness("chain", Wheel(2.0)),))

    def test_are_written_as_their_tables(self) -> None:
        assert unstructure(self.cart) == {
            "by": {"name": "rope", "radius": 1.0, "spokes": 32},
            "more": [{"name": "chain", "radius": 2.0, "spokes": 32}],
        }

    def test_are_kept(self) -> None:
        given = {"by": self.cart.by, "more": list(self.cart.more)}
        assert structure(given, Pulled, ("cart",)) == self.cart

    @pytest.mark.parametrize(
        ("table", "place"),
        [({"by": {"name": "rope"}}, "cart.by"), ({"by": cart.by, "more": ["rope"]}, "cart.more[0]")],
    )
    def test_cannot_be_created_from_tables(self, table: Any, place: str) -> None:
        with pytest.raises(StructureError) as refused:
            structure(table, Pulled, ("cart",))
        [fault] = refused.value.faults
        assert ".".join(fault.path) == place
        assert "a table with the key 'name'" in fault.message
