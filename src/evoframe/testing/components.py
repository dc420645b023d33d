"""The laws of all components."""

from __future__ import annotations

from typing import Any, ClassVar, Generic, TypeVar

import attrs
import pytest

from evoframe.config import resolve_component
from evoframe.contract import SupportsBitGeneration
from evoframe.documents import unstructure

__all__ = ["ComponentContract"]

C = TypeVar("C")


class ComponentContract(Generic[C]):
    """The laws of all components; the contract of each protocol inherits them.

    Attributes:
        component: The component under test.
        protocol: The protocol that it implements.
    """

    component: C
    protocol: ClassVar[type[Any]] = object

    def test_it_implements_its_protocol(self) -> None:
        """A component has every method and property of its protocol."""
        assert isinstance(self.component, self.protocol), (
            f"{type(self.component).__name__} lacks a method or property of {self.protocol.__name__}"
        )

    def test_it_is_a_frozen_attrs_class(self) -> None:
        """Options cannot change during a run."""
        name = type(self.component).__name__
        assert attrs.has(type(self.component)), (
            f"{name} is not an attrs class: decorate it with @attrs.frozen"
        )
        names = [field.name for field in _options(self.component)]
        for name in [*names, "some_attribute"]:
            with pytest.raises(attrs.exceptions.FrozenInstanceError):
                setattr(self.component, name, None)

    def test_options_have_a_type_and_a_default_or_an_explanation(self) -> None:
        """Users can write a configuration without reading the code."""
        text = type(self.component).__doc__ or ""
        for field in _options(self.component):
            assert field.type is not None, f"the option '{field.name}' has no type annotation"
            explained = f"{field.name}:" in text
            assert explained or field.default is not attrs.NOTHING, (
                f"the option '{field.name}' has no default: explain it in the docstring, under Attributes"
            )

    def test_defaults_are_valid(self) -> None:
        """If every option has a default, a component can be created without options."""
        if all(field.default is not attrs.NOTHING for field in _options(self.component)):
            type(self.component)()  # type: ignore[call-arg, unused-ignore]

    def test_options_survive_a_configuration_file(self) -> None:
        """A component read from the configuration that a run has written equals the original.

        Components among its options are read with the installed plugins.
        """
        options = unstructure(self.component)
        assert resolve_component(options, type(self.component), ("component",)) == self.component, (
            f"a component created from the written options {options} differs from the original"
        )

    def test_a_bit_generation_is_a_number_from_1(self) -> None:
        """A component that states the generation of its results has a whole number of at least 1."""
        if isinstance(self.component, SupportsBitGeneration):
            number = self.component.bit_generation
            assert type(number) is int, f"expected a whole number, found {number!r}"
            assert number >= 1, f"expected a number >= 1, found {number}"


def _options(component: Any) -> list[attrs.Attribute[Any]]:
    return [field for field in attrs.fields(type(component)) if field.init]
