"""Measurement of all bodies with the same random controllers, which were not evolved for them.

This is the paper's robustness experiment (docs/experiment.md, "The experiments"), for any simulator that
draws controllers.
"""

from __future__ import annotations

import hashlib
import itertools
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import attrs
import numpy as np
from attrs import validators
from numpy.typing import NDArray

from evoframe.contract import Design, ExecutorRun, Objective, Score, SupportsRandomControllers, blaming
from evoframe.errors import ComponentError, ConfigurationError, InputError, WorkerError
from evoframe.evolution import score_designs, stream

__all__ = [
    "Bench",
    "Body",
    "Candidate",
    "Divergence",
    "Robustness",
    "Setting",
    "digest_of",
    "draw_controller",
]

_BATCH = 8  # controllers of one body, which share the solver's preparation of the body
_BATCHES_PER_WORKER = 8  # between two reports of progress


@attrs.frozen(eq=False)
class Candidate:
    """A body to measure.

    Attributes:
        label: Name of the body.
        group: Name of its group; its own label if it is alone.
        design: The body; its controller is ignored.
        source: File or directory of the body.
        dialect: Name of the program by whose rules the file was read; empty if there is no choice.
    """

    label: str
    group: str
    design: Design
    source: str
    dialect: str = ""


@attrs.frozen
class Body:
    """A measured body.

    Attributes:
        label: Name of the body.
        group: Name of its group; its own label if it is alone.
        digest: Digest of all roles that a random controller does not replace; equal for equal bodies.
        source: File or directory of the body.
        dialect: Name of the program by whose rules the file was read; empty if there is no choice.
    """

    label: str
    group: str
    digest: str
    source: str = attrs.field(eq=False)  # copies of a body are equal
    dialect: str = attrs.field(default="", eq=False)  # its effect is in the simulation


@attrs.frozen
class Setting:
    """The settings that determine the result of a measurement.

    Attributes:
        seed: Seed of all controllers.
        controllers: Number of controllers; a larger number includes the controllers of a smaller one.
        unit: Unit of the scores; empty if the objective does not define one.
        simulation: The tables ``simulator`` and ``objective``.
        bodies: The bodies, in the order of columns.
    """

    seed: int = attrs.field(validator=validators.ge(0))
    controllers: int = attrs.field(validator=validators.ge(1))
    unit: str
    simulation: Mapping[str, Any]
    bodies: tuple[Body, ...]

    @property
    def groups(self) -> dict[str, list[int]]:
        """Name of each group -> columns of its bodies; groups are in the order of their first columns."""
        found: dict[str, list[int]] = {}
        for column, body in enumerate(self.bodies):
            found.setdefault(body.group, []).append(column)
        return found


@attrs.frozen
class Divergence:
    """A simulation that diverged, and has no score.

    Attributes:
        controller: Number of the controller: the row.
        body: Number of the body: the column.
        step: The step at which it diverged.
    """

    controller: int
    body: int
    step: int


@attrs.frozen(eq=False)
class Robustness:
    """Scores of bodies with the same random controllers.

    Attributes:
        setting: Setting of the measurement.
        scores: ``float64[controllers, bodies]``, in the objective's unit; NaN where a simulation diverged.
        diverged: The diverged simulations, row by row.
    """

    setting: Setting
    scores: NDArray[np.float64]
    diverged: tuple[Divergence, ...]

    @property
    def common(self) -> NDArray[np.intp]:
        """The rows without divergence, in which all bodies can be compared."""
        return np.flatnonzero(np.isfinite(self.scores).all(axis=1))

    def values(self, columns: Sequence[int]) -> NDArray[np.float64]:
        """Return all scores of some bodies, without diverged simulations."""
        chosen = self.scores[:, columns].ravel()
        finite: NDArray[np.float64] = chosen[np.isfinite(chosen)]
        return finite

    def lost(self, columns: Sequence[int]) -> int:
        """Return the number of diverged simulations of some bodies."""
        return sum(divergence.body in columns for divergence in self.diverged)


def draw_controller(
    simulator: SupportsRandomControllers, design: Design, seed: int, controller: int
) -> Design:
    """Return a body with a random controller, which depends only on seed and number.

    Raises:
        ComponentError: The simulator failed, or did not return a design.
    """
    with blaming("simulator"):
        drawn = simulator.random_controller(design, stream(seed, f"robustness/{controller}"))
    if not isinstance(drawn, Design):
        raise ComponentError(
            "simulator", f"random_controller must return a Design, but returned {type(drawn).__name__}"
        )
    return drawn


def digest_of(simulator: SupportsRandomControllers, design: Design) -> str:
    """Return the digest of the roles of a design that a random controller does not replace."""
    drawn = draw_controller(simulator, design, 0, 0)
    digest = hashlib.sha256()
    for role, array in sorted(design.roles.items()):
        if np.array_equal(array, drawn.roles.get(role, np.empty(0))):
            digest.update(repr((role, array.dtype.str, array.shape)).encode())
            digest.update(array.tobytes())
    return digest.hexdigest()


@attrs.frozen
class Bench:
    """The components of a measurement.

    Attributes:
        simulator: Draws the controllers, and simulates.
        objective: Scores the outcomes.
        workers: Workers of the executor; results do not depend on their number.
    """

    simulator: SupportsRandomControllers
    objective: Objective
    workers: ExecutorRun

    def measure(
        self, setting: Setting, designs: Sequence[Design], on_progress: Callable[[int], None] = lambda _: None
    ) -> Robustness:
        """Simulate bodies with the same random controllers.

        Args:
            setting: Setting of the measurement.
            designs: A design for each body of the setting.
            on_progress: Called repeatedly with the number of simulations finished since its last call.

        Raises:
            InputError: The simulator cannot simulate a body.
            ComponentError: The simulator or the objective failed, or broke its contract.
        """
        scores = np.full((setting.controllers, len(designs)), np.nan)
        diverged: list[Divergence] = []
        for batch, found in self._scored(setting, designs):
            for controller, score in zip(batch.controllers, found, strict=True):
                if score.diverged_at is None:
                    scores[controller, batch.body] = score.value
                else:
                    diverged.append(Divergence(controller, batch.body, score.diverged_at))
            on_progress(len(found))
        scores.setflags(write=False)
        diverged.sort(key=lambda divergence: (divergence.controller, divergence.body))
        return Robustness(setting, scores, tuple(diverged))

    def _scored(
        self, setting: Setting, designs: Sequence[Design]
    ) -> Iterator[tuple[_Batch, Sequence[Score]]]:
        work = _Work(self.simulator, self.objective, setting.seed)
        batches = _batches(setting, designs)
        while portion := list(itertools.islice(batches, _BATCHES_PER_WORKER * self.workers.workers)):
            try:
                with blaming("executor"):
                    found = self.workers.map(work, portion)
            except WorkerError as lost:
                raise ComponentError("simulator", lost.problem, lost.item.about) from lost
            yield from zip(portion, found, strict=True)


@attrs.frozen(eq=False)
class _Batch:
    """A body and the numbers of its controllers; the worker draws the controllers, which are not sent."""

    body: int
    label: str
    design: Design
    controllers: range

    @property
    def about(self) -> str:
        return f"{self.label}, controllers {self.controllers[0]} to {self.controllers[-1]}"


@attrs.frozen
class _Work:
    """The function that a worker applies to a batch."""

    simulator: SupportsRandomControllers
    objective: Objective
    seed: int

    def __call__(self, batch: _Batch) -> list[Score]:
        try:
            designs = [
                draw_controller(self.simulator, batch.design, self.seed, number)
                for number in batch.controllers
            ]
            return score_designs(self.simulator, designs, self.objective.record, self.objective)
        except (ConfigurationError, InputError) as error:
            raise type(error)(str(error), source=batch.label) from error
        except ComponentError as error:
            raise attrs.evolve(error, concerns=batch.about) from error


def _batches(setting: Setting, designs: Sequence[Design]) -> Iterator[_Batch]:
    for number, (body, design) in enumerate(zip(setting.bodies, designs, strict=True)):
        for first in range(0, setting.controllers, _BATCH):
            end = min(first + _BATCH, setting.controllers)
            yield _Batch(number, body.label, design, range(first, end))
