"""The laws of encoders."""

from __future__ import annotations

import numpy as np
from hypothesis import strategies as st

from evoframe.contract import Design, Encoder, Network, SupportsInputNames, SupportsOutputNames
from evoframe.testing.components import ComponentContract
from evoframe.testing.laws import for_all, random_network, same_arrays

__all__ = ["EncoderContract"]


class EncoderContract(ComponentContract[Encoder]):
    """The laws of an :class:`~evoframe.Encoder`.

    An encoder that requires roles overrides :meth:`design`. Names of inputs and outputs are tested where they
    are offered.
    """

    protocol = Encoder

    def design(self) -> Design:
        """Return a design with the roles that the encoder requires."""
        return Design()

    def networks(self) -> st.SearchStrategy[Network]:
        """Return networks of the encoder's inputs and outputs, from silent ones to enormous ones."""
        return st.builds(
            random_network,
            inputs=st.just(self.component.inputs),
            outputs=st.just(self.component.outputs),
            seed=st.integers(0, 2**32 - 1),
            scale=st.sampled_from([0.0, 1e-3, 1.0, 10.0, 1e50]),
        )

    def test_roles_are_declared(self) -> None:
        """Names in tuples; what is provided was not there before."""
        requires, provides = self.component.requires, self.component.provides
        assert isinstance(requires, tuple)
        assert isinstance(provides, tuple)
        assert provides, "an encoder provides at least one role"
        assert not set(requires) & set(provides)
        assert all(isinstance(role, str) for role in (*requires, *provides))

    def test_a_network_has_inputs_and_outputs(self) -> None:
        """At least one of each."""
        assert self.component.inputs >= 1
        assert self.component.outputs >= 1

    def test_names_are_as_many_as_inputs_and_outputs(self) -> None:
        """A tuple of different words for each, so that a figure can tell them apart."""
        offered: list[tuple[str, tuple[str, ...], int]] = []
        if isinstance(self.component, SupportsInputNames):
            offered.append(("input_names", self.component.input_names, self.component.inputs))
        if isinstance(self.component, SupportsOutputNames):
            offered.append(("output_names", self.component.output_names, self.component.outputs))
        for key, names, number in offered:
            assert isinstance(names, tuple), f"{key} is no tuple"
            assert len(names) == number
            assert all(isinstance(name, str) and name.strip() for name in names)
            assert len(set(names)) == len(names), f"{key} has the same name twice"

    def test_the_example_has_the_required_roles(self) -> None:
        """Otherwise the other tests say nothing: override ``design()``."""
        assert set(self.component.requires) <= set(self.design().roles)

    def test_every_network_gives_the_declared_roles(self) -> None:
        """Those provided are added to the design, no others."""

        def law(network: Network) -> None:
            design = self.design()
            decoded = self.component.decode(network, design)
            assert set(decoded.roles) == {*design.roles, *self.component.provides}

        for_all(law, network=self.networks())

    def test_shapes_and_types_are_the_same_for_every_network(self) -> None:
        """A batch of designs is one array."""
        reference = self._provided(random_network(self.component.inputs, self.component.outputs, 0, 1.0))

        def law(network: Network) -> None:
            for role, array in self._provided(network).items():
                assert array.shape == reference[role].shape
                assert array.dtype == reference[role].dtype

        for_all(law, network=self.networks())

    def test_every_network_gives_finite_numbers(self) -> None:
        """Whatever a network answers, there is a design to simulate."""

        def law(network: Network) -> None:
            for role, array in self._provided(network).items():
                assert np.isfinite(array).all(), f"the role '{role}' is not finite"

        for_all(law, network=self.networks())

    def test_the_same_network_gives_the_same_design(self) -> None:
        """To the last bit."""

        def law(network: Network) -> None:
            assert same_arrays(self._provided(network), self._provided(network))

        for_all(law, network=self.networks())

    def test_the_design_that_is_given_is_left_alone(self) -> None:
        """Its roles are part of the result, unchanged."""

        def law(network: Network) -> None:
            given = self.design()
            decoded = self.component.decode(network, given)
            assert same_arrays(given.roles, self.design().roles)
            assert same_arrays({role: decoded.roles[role] for role in given.roles}, given.roles)

        for_all(law, network=self.networks())

    def _provided(self, network: Network) -> dict[str, np.ndarray]:
        decoded = self.component.decode(network, self.design())
        return {role: decoded.roles[role] for role in self.component.provides}
