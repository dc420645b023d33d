"""How do bodies do with controllers that nobody evolved for them? All of them with the same random ones.

The paper's robustness experiment (paper.md, "The experiments", 2), for any simulator that draws controllers.
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

_BATCH = 8  # controllers of one body: as many share what the solver prepares for it
_BATCHES_PER_WORKER = 8  # between two looks at how far it is


@attrs.frozen(eq=False)
class Candidate:
    """A body that is to be measured.

    Attributes:
        label: What a person calls it.
        group: Which bodies it belongs to; its own label if to no others.
        design: The body; its controller does not matter.
        source: The file or directory that it is from.
    """

    label: str
    group: str
    design: Design
    source: str


@attrs.frozen
class Body:
    """A body that was measured.

    Attributes:
        label: What a person calls it.
        group: Which bodies it belongs to; its own label if to no others.
        digest: Of all roles that a random controller leaves as they are: the same for equal bodies.
        source: The file or directory that it is from.
    """

    label: str
    group: str
    digest: str
    source: str = attrs.field(eq=False)  # the same body from elsewhere is the same body


@attrs.frozen
class Setting:
    """All that decides a measurement.

    Attributes:
        seed: All controllers derive from it.
        controllers: How many are drawn; a greater number has those of a smaller one, and more.
        unit: Of the scores; empty if the objective does not say.
        simulation: The tables ``simulator`` and ``objective``.
        bodies: In the order of columns.
    """

    seed: int = attrs.field(validator=validators.ge(0))
    controllers: int = attrs.field(validator=validators.ge(1))
    unit: str
    simulation: Mapping[str, Any]
    bodies: tuple[Body, ...]

    @property
    def groups(self) -> dict[str, list[int]]:
        """Name -> the columns of its bodies, in the order of their first ones."""
        found: dict[str, list[int]] = {}
        for column, body in enumerate(self.bodies):
            found.setdefault(body.group, []).append(column)
        return found


@attrs.frozen
class Divergence:
    """A simulation that has no score.

    Attributes:
        controller: The row.
        body: The column.
        step: The step at which it diverged.
    """

    controller: int
    body: int
    step: int


@attrs.frozen(eq=False)
class Robustness:
    """What bodies score with the same random controllers.

    Attributes:
        setting: What was measured.
        scores: ``float64[controllers, bodies]``, in the objective's unit; NaN where a simulation diverged.
        diverged: Those places, row by row.
    """

    setting: Setting
    scores: NDArray[np.float64]
    diverged: tuple[Divergence, ...]

    @property
    def common(self) -> NDArray[np.intp]:
        """The rows in which no body diverged: the only ones in which all can be compared."""
        return np.flatnonzero(np.isfinite(self.scores).all(axis=1))

    def values(self, columns: Sequence[int]) -> NDArray[np.float64]:
        """Return all scores of some bodies, without those of simulations that diverged."""
        chosen = self.scores[:, columns].ravel()
        finite: NDArray[np.float64] = chosen[np.isfinite(chosen)]
        return finite

    def lost(self, columns: Sequence[int]) -> int:
        """Return how many simulations of some bodies diverged."""
        return sum(divergence.body in columns for divergence in self.diverged)


def draw_controller(
    simulator: SupportsRandomControllers, design: Design, seed: int, controller: int
) -> Design:
    """Return a body with one of the controllers of a seed, whichever was drawn before.

    Raises:
        ComponentError: The simulator failed, or returned no design.
    """
    with blaming("simulator"):
        drawn = simulator.random_controller(design, stream(seed, f"robustness/{controller}"))
    if not isinstance(drawn, Design):
        raise ComponentError("simulator", f"drew a controller that is no Design, but {type(drawn).__name__}")
    return drawn


def digest_of(simulator: SupportsRandomControllers, design: Design) -> str:
    """Return the digest of what remains of a design whatever controller is drawn for it."""
    drawn = draw_controller(simulator, design, 0, 0)
    digest = hashlib.sha256()
    for role, array in sorted(design.roles.items()):
        if np.array_equal(array, drawn.roles.get(role, np.empty(0))):
            digest.update(repr((role, array.dtype.str, array.shape)).encode())
            digest.update(array.tobytes())
    return digest.hexdigest()


@attrs.frozen
class Bench:
    """What measures.

    Attributes:
        simulator: Draws the controllers, and simulates.
        objective: Scores.
        workers: Simulate at the same time; the results do not depend on them.
    """

    simulator: SupportsRandomControllers
    objective: Objective
    workers: ExecutorRun

    def measure(
        self, setting: Setting, designs: Sequence[Design], on_progress: Callable[[int], None] = lambda _: None
    ) -> Robustness:
        """Simulate bodies with the same random controllers.

        Args:
            setting: What is measured.
            designs: A design for each of its bodies.
            on_progress: Called now and then with the number of simulations done since the last time.

        Raises:
            InputError: The simulator cannot simulate a body.
            ComponentError: The simulator or the objective did not keep its word.
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
    """One body with some of the controllers; they are drawn by the worker, which may be far away."""

    body: int
    label: str
    design: Design
    controllers: range

    @property
    def about(self) -> str:
        return f"{self.label}, controllers {self.controllers[0]} to {self.controllers[-1]}"


@attrs.frozen
class _Work:
    """What a worker does with a batch."""

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
            raise type(error)(f"{batch.label}: {error}") from error
        except ComponentError as error:
            raise attrs.evolve(error, concerns=batch.about) from error


def _batches(setting: Setting, designs: Sequence[Design]) -> Iterator[_Batch]:
    for number, (body, design) in enumerate(zip(setting.bodies, designs, strict=True)):
        for first in range(0, setting.controllers, _BATCH):
            end = min(first + _BATCH, setting.controllers)
            yield _Batch(number, body.label, design, range(first, end))
