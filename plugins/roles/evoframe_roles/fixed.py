"""Roles of given designs: the providers ``file``, ``published`` and ``champion``."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import attrs
import numpy as np

from evoframe import (
    MORPHOLOGY,
    ConfigurationError,
    Design,
    Simulator,
    SupportsPublished,
    SupportsReading,
)

__all__ = ["Champion", "File", "Published"]


@attrs.frozen
class _Fixed:
    """Base of the providers that take roles from a given design."""

    roles: tuple[str, ...] = attrs.field(default=(MORPHOLOGY,))

    @property
    def requires(self) -> tuple[str, ...]:
        """Nothing: the design is complete."""
        return ()

    @property
    def provides(self) -> tuple[str, ...]:
        """The roles that are taken from the design."""
        return self.roles


@attrs.frozen
class File(_Fixed):
    """Roles of a design in a file that the simulator reads, such as a body in an ``.npz`` or ``.vxa`` file.

    Attributes:
        roles: The roles to take.
        path: The file, relative to the working directory.
        design: Label of the design; empty: the only one.
    """

    path: str = ""
    design: str = ""

    def start(self, simulator: Simulator) -> _Given:
        """Read the file.

        Raises:
            ConfigurationError: The simulator reads no files, or the file has no such design.
            InputError: The file cannot be read.
        """
        if not isinstance(simulator, SupportsReading):
            raise ConfigurationError(f"{type(simulator).__name__} reads no files with designs")
        if not self.path:
            raise ConfigurationError("no file is given; set the option path")
        return _given(simulator.read(Path(self.path)), self.design, self.roles, self.path)


@attrs.frozen
class Published(_Fixed):
    """Roles of a published design that the simulator includes.

    Attributes:
        roles: The roles to take.
        design: Label of the design.
    """

    design: str = ""

    def start(self, simulator: Simulator) -> _Given:
        """Find the design.

        Raises:
            ConfigurationError: The simulator includes no such design; names those that it includes.
        """
        if not isinstance(simulator, SupportsPublished):
            raise ConfigurationError(f"{type(simulator).__name__} includes no published designs")
        return _given(simulator.published(), self.design, self.roles, "the published designs")


@attrs.frozen
class Champion(_Fixed):
    """Roles of the champion of another run.

    Attributes:
        roles: The roles to take.
        run: Directory of the run, relative to the working directory.
    """

    run: str = ""

    def start(self, simulator: Simulator) -> _Given:  # noqa: ARG002
        """Read the champion.

        Raises:
            ConfigurationError: No run is given, or its champion lacks a role.
            InputError: The run cannot be read.
        """
        from evoframe import load_run  # noqa: PLC0415 - slow to import, and needed here only

        if not self.run:
            raise ConfigurationError("no run is given; set the option run to its directory")
        return _given([("champion", load_run(self.run).champion().design)], "", self.roles, self.run)


@attrs.frozen(eq=False)
class _Given:
    """The roles of a given design."""

    design: Design
    roles: tuple[str, ...]
    source: str

    def fill(self, design: Design, rng: np.random.Generator) -> Design:  # noqa: ARG002
        """Return *design* with the roles; *rng* is not used."""
        return Design({**design.roles, **{role: self.design.roles[role] for role in self.roles}})

    def state(self) -> str:
        """Return a checksum of the roles."""
        digest = hashlib.sha256()
        for role in self.roles:
            array = self.design.roles[role]
            digest.update(f"{role} {array.dtype.str} {array.shape} ".encode() + array.tobytes())
        return digest.hexdigest()

    def restore(self, state: Any) -> None:
        """Compare the roles with those at the start of the run.

        Raises:
            ValueError: They differ.
        """
        if state != self.state():
            raise ValueError(f"{self.source}: the design differs from that with which the run started")


def _given(designs: Sequence[tuple[str, Design]], wanted: str, roles: tuple[str, ...], source: str) -> _Given:
    found = [design for label, design in designs if wanted in (label, "")]
    if len(found) != 1:
        labels = ", ".join(label for label, _ in designs)
        asked = f"{len(found) or 'no'} designs '{wanted}'" if wanted else "several designs, none is chosen"
        raise ConfigurationError(f"{source}: {asked}; set the option design to one of: {labels}")
    lacking = [role for role in roles if role not in found[0].roles]
    if lacking:
        there = ", ".join(found[0].roles)
        raise ConfigurationError(f"{source}: the design lacks the role '{lacking[0]}'; its roles: {there}")
    return _Given(found[0], roles, source)
