"""The laws of encoders."""

from __future__ import annotations

import math

import numpy as np
from hypothesis import strategies as st

from evoframe.contract import (
    ArrayType,
    Design,
    Encoder,
    Network,
    SupportsArrayTypes,
    SupportsDesignMeasures,
    SupportsInputNames,
    SupportsOutputNames,
)
from evoframe.testing.components import ComponentContract
from evoframe.testing.laws import for_all, random_network, same_arrays

__all__ = ["EncoderContract"]


class EncoderContract(ComponentContract[Encoder]):
    """The laws of an :class:`~evoframe.Encoder`.

    If the encoder requires roles, override :meth:`design`. Names of inputs and outputs, types of arrays and
    measures are tested if the encoder has them.
    """

    protocol = Encoder

    def design(self) -> Design:
        """Return a design with the roles that the encoder requires."""
        return Design()

    def networks(self) -> st.SearchStrategy[Network]:
        """Return networks with the encoder's inputs and outputs, with outputs from 0 to about 1e50."""
        return st.builds(
            random_network,
            inputs=st.just(self.component.inputs),
            outputs=st.just(self.component.outputs),
            seed=st.integers(0, 2**32 - 1),
            scale=st.sampled_from([0.0, 1e-3, 1.0, 10.0, 1e50]),
        )

    def test_roles_are_declared(self) -> None:
        """``requires`` and ``provides`` are disjoint tuples of names, and at least one role is provided."""
        requires, provides = self.component.requires, self.component.provides
        assert isinstance(requires, tuple), f"requires must be a tuple, found {type(requires).__name__}"
        assert isinstance(provides, tuple), f"provides must be a tuple, found {type(provides).__name__}"
        assert provides, "an encoder must provide at least one role"
        both = sorted(set(requires) & set(provides))
        assert not both, f"an encoder must not both require and provide a role, found {both}"
        assert all(isinstance(role, str) for role in (*requires, *provides)), "roles must be strings"

    def test_a_network_has_inputs_and_outputs(self) -> None:
        """A network has at least one output; one without inputs is evaluated at points of shape (n, 0)."""
        assert self.component.inputs >= 0, f"expected 0 or more inputs, found {self.component.inputs}"
        assert self.component.outputs >= 1, f"expected at least 1 output, found {self.component.outputs}"

    def test_every_input_and_output_has_a_name(self) -> None:
        """Names are tuples of different strings, so that figures can distinguish inputs and outputs."""
        offered: list[tuple[str, tuple[str, ...], int]] = []
        if isinstance(self.component, SupportsInputNames):
            offered.append(("input_names", self.component.input_names, self.component.inputs))
        if isinstance(self.component, SupportsOutputNames):
            offered.append(("output_names", self.component.output_names, self.component.outputs))
        for key, names, number in offered:
            assert isinstance(names, tuple), f"{key} must be a tuple, found {type(names).__name__}"
            assert len(names) == number, f"{key} must have {number} names, found {len(names)}"
            assert all(isinstance(name, str) and name.strip() for name in names), (
                f"{key} must be strings that are not empty, found {names}"
            )
            assert len(set(names)) == len(names), f"{key} must be different names, found {names}"

    def test_the_example_has_the_required_roles(self) -> None:
        """The example of ``design()`` has all required roles; the other tests depend on it."""
        missing = sorted(set(self.component.requires) - set(self.design().roles))
        assert not missing, f"override design() to return a design with the required roles {missing}"

    def test_every_network_gives_the_declared_roles(self) -> None:
        """``decode`` adds exactly the provided roles to the design."""

        def law(network: Network) -> None:
            design = self.design()
            decoded = self.component.decode(network, design)
            expected = {*design.roles, *self.component.provides}
            assert set(decoded.roles) == expected, (
                f"decode() must return the roles {sorted(expected)}, found {sorted(decoded.roles)}"
            )

        for_all(law, network=self.networks())

    def test_shapes_and_types_are_the_same_for_every_network(self) -> None:
        """The shape and type of a role do not depend on the network, so that designs can be batched."""
        reference = self._provided(random_network(self.component.inputs, self.component.outputs, 0, 1.0))

        def law(network: Network) -> None:
            for role, array in self._provided(network).items():
                shape, dtype = reference[role].shape, reference[role].dtype
                assert array.shape == shape, f"role '{role}': expected shape {shape}, found {array.shape}"
                assert array.dtype == dtype, f"role '{role}': expected {dtype}, found {array.dtype}"

        for_all(law, network=self.networks())

    def test_every_network_gives_finite_numbers(self) -> None:
        """Every network gives a design that can be simulated, even with enormous outputs."""

        def law(network: Network) -> None:
            for role, array in self._provided(network).items():
                assert np.isfinite(array).all(), (
                    f"role '{role}': expected finite values for any network; clamp its outputs"
                )

        for_all(law, network=self.networks())

    def test_the_same_network_gives_the_same_design(self) -> None:
        """Decoding a network twice gives the same design, to the last bit."""

        def law(network: Network) -> None:
            first, second = self._provided(network), self._provided(network)
            assert same_arrays(first, second), "decode() gives different designs for the same network"

        for_all(law, network=self.networks())

    def test_the_given_design_is_not_changed(self) -> None:
        """The roles of the given design are unchanged, also in the result."""

        def law(network: Network) -> None:
            given = self.design()
            decoded = self.component.decode(network, given)
            assert same_arrays(given.roles, self.design().roles), (
                "decode() changes the design that it is given"
            )
            kept = {role: decoded.roles[role] for role in given.roles}
            assert same_arrays(kept, given.roles), (
                "decode() must keep the roles of the given design unchanged"
            )

        for_all(law, network=self.networks())

    def test_arrays_have_the_declared_types(self) -> None:
        """Arrays of the roles in ``array_types`` have the declared types and shapes."""
        component = self.component
        if not isinstance(component, SupportsArrayTypes):
            return
        declared = component.array_types
        unknown = sorted(declared.keys() - {*component.requires, *component.provides})
        assert not unknown, f"array_types: expected roles that it requires or provides, found {unknown}"

        def law(network: Network) -> None:
            decoded = component.decode(network, self.design())
            for role, type_ in declared.items():
                there = ArrayType.of(decoded.roles[role])
                assert type_.accepts(there), f"role '{role}': expected {type_}, found {there}"

        for_all(law, network=self.networks())

    def test_all_declared_measures_are_finite(self) -> None:
        """``measure`` returns the declared measures, and no others, as finite numbers."""
        component = self.component
        if not isinstance(component, SupportsDesignMeasures):
            return

        def law(network: Network) -> None:
            measured = component.measure(component.decode(network, self.design()))
            assert set(measured) == set(component.measures), (
                f"expected the measures {sorted(component.measures)}, found {sorted(measured)}"
            )
            for name, value in measured.items():
                assert math.isfinite(value), f"measure '{name}': expected a finite number, found {value}"

        for_all(law, network=self.networks())

    def _provided(self, network: Network) -> dict[str, np.ndarray]:
        decoded = self.component.decode(network, self.design())
        return {role: decoded.roles[role] for role in self.component.provides}
