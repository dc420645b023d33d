"""Roles of designs that no population evolves."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import attrs

from evoframe.contract import Design, RoleProvider, RoleRun, RunConfig, Simulator, blaming
from evoframe.errors import ComponentError, ConfigurationError, InputError
from evoframe.evolution.randomness import stream

__all__ = ["Role", "Roles", "roles_of"]


@attrs.define
class Role:
    """Roles that a provider fills in.

    Attributes:
        name: Name in the configuration.
        provider: Declares the roles.
        run: Provides them.
        draw: When a random one is drawn: ``run``, ``turn`` or ``individual``.
        seed: Seed of the run.
    """

    name: str
    provider: RoleProvider
    run: RoleRun
    draw: str
    seed: int
    _filled: dict[tuple[Design, str], Design] = attrs.field(factory=dict, init=False)

    @property
    def key(self) -> str:
        """Dotted key of the provider in the configuration."""
        return f"roles.{self.name}.provider"

    def forget(self) -> None:
        """Forget the designs of earlier turns."""
        self._filled.clear()

    def fill(self, design: Design, turn: int, individual: str) -> Design:
        """Return *design* with the roles; the same arguments give the same object in a turn.

        Args:
            design: The design so far; compared by identity.
            turn: Index of the turn.
            individual: Name of the individual that is evaluated.
        """
        drawn_for = {"run": "", "turn": f"/{turn}", "individual": f"/{turn}/{individual}"}[self.draw]
        if (design, drawn_for) not in self._filled:
            with blaming(self.key, individual):
                filled = self.run.fill(design, stream(self.seed, f"role/{self.name}{drawn_for}"))
                lacking = [role for role in self.provider.provides if role not in filled.roles]
            if lacking:
                raise ComponentError(self.key, f"did not provide the role '{lacking[0]}'", individual)
            self._filled[design, drawn_for] = filled
        return self._filled[design, drawn_for]


@attrs.define
class Roles:
    """All roles that no population evolves.

    Attributes:
        roles: The roles, in the order of the configuration.
        turn: Index of the turn for which they are drawn.
    """

    roles: tuple[Role, ...] = ()
    turn: int = 0
    _empty: Design = attrs.field(factory=Design, init=False)

    @property
    def are_redrawn(self) -> bool:
        """True if individuals that meet again can get another design."""
        return any(role.draw != "run" for role in self.roles)

    def begin_turn(self, turn: int) -> None:
        """Draw for this turn from now on."""
        self.turn = turn
        for role in self.roles:
            role.forget()

    def before(self, individual: str) -> Design:
        """Return the design before any population adds to it."""
        return self._filled(self._empty, individual, [r for r in self.roles if not r.provider.requires])

    def after(self, design: Design, individual: str) -> Design:
        """Return the complete design, after all populations have added to it."""
        return self._filled(design, individual, [r for r in self.roles if r.provider.requires])

    def _filled(self, design: Design, individual: str, roles: Sequence[Role]) -> Design:
        for role in roles:
            design = role.fill(design, self.turn, individual)
        return design

    def state(self) -> dict[str, Any] | None:
        """Return what must be the same on a resume, by the name of the role; ``None`` without roles."""
        states = {}
        for role in self.roles:
            with blaming(role.key):
                states[role.name] = role.run.state()
        return states or None

    def restore(self, state: dict[str, Any]) -> None:
        """Compare with the result of :meth:`state` when the run started.

        Raises:
            ComponentError: Something that a provider depends on has changed.
        """
        for role in self.roles:
            with blaming(role.key):
                role.run.restore(state.get(role.name))


def roles_of(config: RunConfig, simulator: Simulator) -> Roles:
    """Return the roles of a configuration that no population evolves, started."""
    started = []
    for name, given in config.roles.items():
        provider = given.provider.component
        key = f"roles.{name}.provider"
        try:
            with blaming(key):
                run = provider.start(simulator)
        except (ConfigurationError, InputError) as error:
            raise type(error)(error.problem, source=error.source, key=key) from error
        started.append(Role(name, provider, run, given.draw, config.run.seed))
    return Roles(tuple(started))
