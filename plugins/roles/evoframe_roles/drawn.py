"""Random roles: the provider ``random``."""

from __future__ import annotations

from typing import Any

import attrs
import numpy as np

from evoframe import (
    CONTROLLER,
    MORPHOLOGY,
    ConfigurationError,
    Design,
    Simulator,
    SupportsRandomControllers,
)

__all__ = ["RandomController"]


@attrs.frozen
class RandomController:
    """A random controller of the simulator, such as one random phase offset for each voxel.

    With ``draw = "individual"``, each body is evaluated with its own random controller, as in the paper's
    evolution with one population (arXiv 2510.24510).
    """

    @property
    def requires(self) -> tuple[str, ...]:
        """The morphology."""
        return (MORPHOLOGY,)

    @property
    def provides(self) -> tuple[str, ...]:
        """The controller."""
        return (CONTROLLER,)

    def start(self, simulator: Simulator) -> _Drawing:
        """Return the draws.

        Raises:
            ConfigurationError: The simulator draws no random controllers.
        """
        if not isinstance(simulator, SupportsRandomControllers):
            raise ConfigurationError(f"{type(simulator).__name__} draws no random controllers")
        return _Drawing(simulator)


@attrs.frozen
class _Drawing:
    simulator: SupportsRandomControllers

    def fill(self, design: Design, rng: np.random.Generator) -> Design:
        """Return *design* with a controller that *rng* draws."""
        body = design.roles[MORPHOLOGY]
        return self.simulator.random_controller(design.with_role(CONTROLLER, np.zeros(body.shape)), rng)

    def state(self) -> None:
        """Return nothing: random numbers come from the streams of the run."""

    def restore(self, state: Any) -> None:
        """Accept the empty state."""
        if state is not None:
            raise ValueError(f"expected no state, found {state!r}")
