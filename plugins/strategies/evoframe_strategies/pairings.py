"""Strategies that choose for each individual: random pairings with equal shares, and neighbors in space."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import attrs
import numpy as np
from attrs import validators

from evoframe import Judged, Member
from evoframe_strategies.ranking import ChooseN, Indices, as_indices

__all__ = ["Neighbourhood", "Shuffled"]


@attrs.frozen
class Shuffled(ChooseN):
    """Random pairings in which all members take part equally often: *n* different ones for each individual.

    The numbers of individuals that any two members meet differ by at most 1. With diverged members, this is
    true of the clean ones; if there are fewer than *n*, everybody meets them, and the diverged ones take
    equal part in the rest. Source: Luke et al., ECJ, ``ec.coevolve.MultiPopCoevolutionaryEvaluator``
    (shuffled collaborators).

    Attributes:
        n: Number of collaborators of each individual.
    """

    def select(self, members: Sequence[Member], rng: np.random.Generator) -> Indices:
        """Return the indices of the *members* that a single individual meets."""
        return as_indices(self._deal(1, members, rng)[0])

    def select_each(
        self, judged: Sequence[Judged], members: Sequence[Member], rng: np.random.Generator
    ) -> Indices:
        """Return the indices of the *members* that each individual meets, ``intp[len(judged), n]``."""
        return self._deal(len(judged), members, rng)

    def _deal(self, n_hands: int, members: Sequence[Member], rng: np.random.Generator) -> Indices:
        size = self.size(len(members))
        clean = [index for index, member in enumerate(members) if not member.diverged]
        diverged = [index for index, member in enumerate(members) if member.diverged]
        n_clean = min(size, len(clean))
        hands = [_hands(clean, n_hands, n_clean, rng), _hands(diverged, n_hands, size - n_clean, rng)]
        return np.hstack(hands)


def _hands(cards: Sequence[int], n_hands: int, size: int, rng: np.random.Generator) -> Indices:
    """Deal all *cards* equally often to hands of different cards, ``intp[n_hands, size]``."""
    dealt = np.empty((n_hands, size), dtype=np.intp)
    stack: list[int] = []
    for hand in dealt:
        held, stack = stack[:size], stack[size:]
        if len(held) < size:
            # Cards in the hand go to the end of the next stack, so that no hand has one twice.
            shuffled = rng.permutation(cards).tolist()
            shuffled.sort(key=held.__contains__)
            missing = size - len(held)
            held, stack = held + shuffled[:missing], shuffled[missing:]
        hand[:] = held
    return dealt


@attrs.frozen
class Neighbourhood(ChooseN):
    """The *n* members nearest to the individual's own cell: coevolution in space.

    Each population lives in the cells of the same shape, which has no borders; the index of an individual in
    its population is its cell. An individual meets the member in its own cell first, then the nearest ones;
    at equal distance, those that follow in the order of the cells. If the populations have different sizes,
    cells are those of the other population, and counted on from its first cell after its last. As a later
    part of ``sum``, the members that earlier parts left are the cells.

    The evolver decides which offspring are in which cell. Offspring stay near their parents, as in the
    sources, only if it keeps places. Sources: Hillis 1990, "Co-evolving parasites improve simulated evolution
    as an optimization procedure", Physica D 42; Pagie and Hogeweg 1997, "Evolutionary consequences of
    coevolving targets", Evolutionary Computation 5; Williams and Mitchell 2005, "Investigating the success of
    spatial coevolution", GECCO.

    Attributes:
        n: Number of collaborators of each individual.
        shape: Shape of the population: ``ring``, or ``torus``, a grid that is as square as the size of the
            population allows (25: 5 x 5, 24: 4 x 6, 23: 1 x 23), with steps along rows and columns.
    """

    shape: str = attrs.field(default="ring", validator=validators.in_(("ring", "torus")))

    def select(self, members: Sequence[Member], rng: np.random.Generator) -> Indices:  # noqa: ARG002
        """Return the indices of the *members* that the individual in the first cell meets."""
        return self._nearest(0, members)

    def select_each(
        self,
        judged: Sequence[Judged],
        members: Sequence[Member],
        rng: np.random.Generator,  # noqa: ARG002
    ) -> Indices:
        """Return the indices of the nearest *members*, ``intp[len(judged), n]``; *rng* is not used."""
        nearest = [self._nearest(individual.index, members) for individual in judged]
        return np.array(nearest, dtype=np.intp).reshape(len(judged), self.size(len(members)))

    def _nearest(self, place: int, members: Sequence[Member]) -> Indices:
        size = self.size(len(members))
        rows = 1 if self.shape == "ring" else _rows(len(members))
        around = list(_around(place % len(members), rows, len(members) // rows))
        around.sort(key=lambda index: members[index].diverged)
        return as_indices(around[:size])


def _rows(n_cells: int) -> int:
    """Return the number of rows of a grid of *n_cells* that is as square as possible."""
    return max(rows for rows in range(1, math.isqrt(n_cells) + 1) if n_cells % rows == 0)


def _around(cell: int, rows: int, columns: int) -> Iterator[int]:
    """Yield all cells of a torus, the nearest to *cell* first, at equal distance those that follow it."""
    row, column = divmod(cell, columns)
    steps = [(down, right) for down in range(rows) for right in range(columns)]
    steps.sort(key=lambda step: min(step[0], rows - step[0]) + min(step[1], columns - step[1]))
    for down, right in steps:
        yield (row + down) % rows * columns + (column + right) % columns
