"""The laws of providers of roles that no population evolves."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest
from hypothesis import strategies as st

from evoframe.contract import Design, RoleProvider, RoleRun, Simulator
from evoframe.testing.components import ComponentContract
from evoframe.testing.laws import for_all, global_random_state_untouched, same_arrays

__all__ = ["RoleProviderContract"]

_SEEDS = st.integers(0, 2**32 - 1)
_ANOTHER_STATE = {"the state": "of another run"}


class RoleProviderContract(ComponentContract[RoleProvider]):
    """The laws of a :class:`~evoframe.RoleProvider` and of the :class:`~evoframe.RoleRun` that it starts.

    Attributes:
        simulator: A simulator for whose designs the provider can start.
    """

    protocol = RoleProvider
    simulator: Simulator

    def design(self) -> Design:
        """Return an example of a design with the required roles; by default an empty one."""
        return Design()

    def test_roles_are_declared(self) -> None:
        """``requires`` and ``provides`` are disjoint tuples of names, and at least one role is provided."""
        requires, provides = self.component.requires, self.component.provides
        for key, roles in (("requires", requires), ("provides", provides)):
            assert isinstance(roles, tuple), f"{key} must be a tuple, found {type(roles).__name__}"
            assert all(isinstance(role, str) for role in roles), f"{key} must be strings, found {roles}"
        assert provides, "a provider must provide at least one role"
        both = sorted(set(requires) & set(provides))
        assert not both, f"a provider must not both require and provide a role, found {both}"

    def test_the_example_has_the_required_roles(self) -> None:
        """The example of ``design()`` has all required roles; the other tests depend on it."""
        missing = sorted(set(self.component.requires) - set(self.design().roles))
        assert not missing, f"override design() to return a design with the required roles {missing}"

    def test_it_starts_a_run(self) -> None:
        """``start`` returns an object with every method of :class:`~evoframe.RoleRun`."""
        run = self._started()
        assert isinstance(run, RoleRun), f"{type(run).__name__} lacks a method of RoleRun"

    def test_the_declared_roles_are_added(self) -> None:
        """``fill`` adds exactly the provided roles to the design."""

        def law(seed: int) -> None:
            design = self.design()
            filled = self._filled(design, seed)
            expected = {*design.roles, *self.component.provides}
            assert set(filled.roles) == expected, (
                f"fill() must return the roles {sorted(expected)}, found {sorted(filled.roles)}"
            )

        for_all(law, seed=_SEEDS)

    def test_the_given_design_is_not_changed(self) -> None:
        """The roles of the given design are unchanged, also in the result."""

        def law(seed: int) -> None:
            design = self.design()
            filled = self._filled(design, seed)
            assert same_arrays(design.roles, self.design().roles), (
                "fill() changes the design that it is given"
            )
            kept = {role: filled.roles[role] for role in design.roles}
            assert same_arrays(kept, design.roles), "fill() must keep the roles of the given design unchanged"

        for_all(law, seed=_SEEDS)

    def test_the_same_random_state_gives_the_same_roles(self) -> None:
        """The result depends only on the design and the given generator, not on earlier calls."""
        run = self._started()

        def law(seed: int, other: int) -> None:
            with global_random_state_untouched():
                first = run.fill(self.design(), np.random.default_rng(seed))
                run.fill(self.design(), np.random.default_rng(other))
                second = run.fill(self.design(), np.random.default_rng(seed))
            assert same_arrays(first.roles, second.roles), (
                "fill() gives different roles for the same state of the generator"
            )

        for_all(law, seed=_SEEDS, other=_SEEDS)

    def test_another_start_gives_the_same_roles(self) -> None:
        """A resumed run starts its components again."""

        def law(seed: int) -> None:
            first, second = self._filled(self.design(), seed), self._filled(self.design(), seed)
            assert same_arrays(first.roles, second.roles), "another start() gives different roles"

        for_all(law, seed=_SEEDS)

    def test_the_state_is_json(self) -> None:
        """``state`` returns JSON values, which are the same before and after ``fill``, and accepted again."""
        run = self._started()
        before = self._state(run)
        run.fill(self.design(), np.random.default_rng(1))
        assert self._state(run) == before, "state() must not change during a run"
        self._started().restore(json.loads(before))

    def test_another_state_is_refused(self) -> None:
        """``restore`` raises ``ValueError`` if the state differs from that of this run."""
        with pytest.raises(ValueError, match=r".+"):
            self._started().restore(_ANOTHER_STATE)

    def _started(self) -> RoleRun:
        return self.component.start(self.simulator)

    def _filled(self, design: Design, seed: int) -> Design:
        return self._started().fill(design, np.random.default_rng(seed))

    def _state(self, run: Any) -> str:
        try:
            return json.dumps(run.state(), allow_nan=False, sort_keys=True)
        except (TypeError, ValueError) as error:
            raise AssertionError(f"state() must return JSON values: {error}") from error
