"""What is true of every component."""

from __future__ import annotations

from typing import Any, ClassVar, Generic, TypeVar

import attrs
import pytest

from evoframe.documents import structure, unstructure

__all__ = ["ComponentContract"]

C = TypeVar("C")


class ComponentContract(Generic[C]):
    """The laws of all components; the contract of each protocol inherits them.

    Attributes:
        component: The component under test.
        protocol: The protocol that it fulfils.
    """

    component: C
    protocol: ClassVar[type[Any]] = object

    def test_it_fulfils_its_protocol(self) -> None:
        """Every method and property of the protocol is there."""
        assert isinstance(self.component, self.protocol)

    def test_it_is_a_frozen_attrs_class(self) -> None:
        """Its options cannot change while a run goes on."""
        assert attrs.has(type(self.component)), "decorate the class with @attrs.frozen"
        names = [field.name for field in _options(self.component)]
        for name in [*names, "some_attribute"]:
            with pytest.raises(attrs.exceptions.FrozenInstanceError):
                setattr(self.component, name, None)

    def test_options_have_a_type_and_a_default_or_an_explanation(self) -> None:
        """Nobody has to read the code to write a configuration."""
        text = type(self.component).__doc__ or ""
        for field in _options(self.component):
            assert field.type is not None, f"the option '{field.name}' has no type"
            explained = f"{field.name}:" in text
            assert explained or field.default is not attrs.NOTHING, (
                f"the option '{field.name}' has no default: explain it in the docstring, under Attributes"
            )

    def test_defaults_make_a_component(self) -> None:
        """Where every option has a default, the name alone is a configuration."""
        if all(field.default is not attrs.NOTHING for field in _options(self.component)):
            type(self.component)()  # type: ignore[call-arg, unused-ignore]

    def test_options_survive_a_configuration_file(self) -> None:
        """What a run writes down of its configuration is the same component when it is read."""
        options = unstructure(self.component)
        assert structure(options, type(self.component), ("component",)) == self.component


def _options(component: Any) -> list[attrs.Attribute[Any]]:
    return [field for field in attrs.fields(type(component)) if field.init]
