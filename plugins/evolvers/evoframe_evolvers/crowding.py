"""neat-python's reproduction, made exact where species crowd each other.

Two things make neat-python 2.0 stop with a RuntimeError: more elites (or least members of species) than the
population has places, and a surplus of offspring that it does not trim to the end. Everywhere else these
classes do what neat-python does.
"""

from __future__ import annotations

import logging
from typing import Any, TypeAlias

import neat

__all__ = ["ExactReproduction", "RoomyStagnation", "fit_exactly"]

_log = logging.getLogger(__name__)

Verdict: TypeAlias = tuple[int, Any, bool]
"""Id of a species, the species, and whether it dies out; neat-python lists the weakest first."""


class RoomyStagnation(neat.DefaultStagnation):  # type: ignore[misc] # neat-python has no types
    """Decides which species die out, and makes room for those that stay.

    Attributes:
        places: The size of the next generation, set by :class:`ExactReproduction`.
        reproduction_config: neat-python's settings, changed for this turn if they ask for too many members.
    """

    def __init__(self, config: Any, reporters: Any, reproduction_config: Any) -> None:
        super().__init__(config, reporters)
        self.places = 0
        self.reproduction_config = reproduction_config

    def update(self, species_set: Any, generation: int) -> list[Verdict]:
        """Return the verdict on every species, the weakest first."""
        verdicts = _without_weakest(super().update(species_set, generation), self.places)
        self._make_room(sum(not dies for _, _, dies in verdicts))
        return verdicts

    def _make_room(self, species: int) -> None:
        rules = self.reproduction_config
        if species * max(rules.elitism, rules.min_species_size) <= self.places:
            return
        _log.info(
            "%d species of at least %d members do not fit into a population of %d: "
            "elitism and min_species_size are 1 for this turn",
            species,
            max(rules.elitism, rules.min_species_size),
            self.places,
        )
        rules.elitism = min(rules.elitism, 1)
        rules.min_species_size = 1


def _without_weakest(verdicts: list[Verdict], places: int) -> list[Verdict]:
    """Let the weakest species die out if there are more than *places*, among equals the oldest."""
    surplus = sum(not dies for _, _, dies in verdicts) - places
    result = []
    for key, species, dies in verdicts:
        loses = not dies and surplus > 0
        if loses:
            surplus -= 1
            _log.warning("species %d loses its place: more species than members", key)
        result.append((key, species, dies or loses))
    return result


class ExactReproduction(neat.DefaultReproduction):  # type: ignore[misc] # neat-python has no types
    """Breeds a generation of exactly the size asked for."""

    def reproduce(self, config: Any, species: Any, pop_size: int, generation: int) -> dict[int, Any]:
        """Return the next generation; empty if every species died out."""
        rules = self.reproduction_config
        asked_for = rules.elitism, rules.min_species_size
        self.stagnation.places = pop_size
        try:
            offspring: dict[int, Any] = super().reproduce(config, species, pop_size, generation)
        finally:
            rules.elitism, rules.min_species_size = asked_for
        self.ancestors.clear()  # it would grow for ever, and nobody reads it
        return offspring

    def _adjust_spawn_exact(
        self, spawn_amounts: list[int], pop_size: int, min_species_size: int
    ) -> list[int]:
        return fit_exactly(spawn_amounts, pop_size, min_species_size)


def fit_exactly(amounts: list[int], size: int, least: int) -> list[int]:
    """Return *amounts* with the sum *size*, none below *least*.

    Round by round, what is missing is added one by one from the smallest on, what is too much is taken one by
    one from the largest on. neat-python breaks off after one round of taking.

    Args:
        amounts: Members that each species would get, each at least *least*.
        size: Members in all, at least *least* for each species.
        least: The fewest members of a species.
    """
    result = list(amounts)
    ascending = sorted(range(len(amounts)), key=lambda i: amounts[i])
    descending = sorted(range(len(amounts)), key=lambda i: -amounts[i])
    while (missing := size - sum(result)) > 0:
        for i in ascending[:missing]:
            result[i] += 1
    while (surplus := sum(result) - size) > 0:
        for i in [i for i in descending if result[i] > least][:surplus]:
            result[i] -= 1
    return result
