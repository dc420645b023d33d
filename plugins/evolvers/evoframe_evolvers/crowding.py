"""neat-python's reproduction, corrected for many species in a small population.

neat-python 2.0 raises a RuntimeError in two cases: if elites (or minimum species sizes) add up to more than
the population size, and if it cannot remove all surplus offspring in one round. In all other cases these
classes behave as neat-python does.
"""

from __future__ import annotations

import logging
from typing import Any, TypeAlias

import neat

__all__ = ["ExactReproduction", "RoomyStagnation", "fit_exactly"]

_log = logging.getLogger(__name__)

Verdict: TypeAlias = tuple[int, Any, bool]
"""Id of a species, the species, and whether it goes extinct; neat-python lists the weakest first."""


class RoomyStagnation(neat.DefaultStagnation):  # type: ignore[misc] # neat-python has no types
    """Stagnation that decides which species go extinct, and that makes the remaining ones fit the population.

    Attributes:
        places: Size of the next generation, set by :class:`ExactReproduction`.
        reproduction_config: neat-python's settings, changed for this turn if they require too many members.
    """

    def __init__(self, config: Any, reporters: Any, reproduction_config: Any) -> None:
        super().__init__(config, reporters)
        self.places = 0
        self.reproduction_config = reproduction_config

    def update(self, species_set: Any, generation: int) -> list[Verdict]:
        """Return the verdict on every species, the weakest first."""
        verdicts = _remove_weakest(super().update(species_set, generation), self.places)
        self._limit_minimum_sizes(sum(not dies for _, _, dies in verdicts))
        return verdicts

    def _limit_minimum_sizes(self, species: int) -> None:
        rules = self.reproduction_config
        if species * max(rules.elitism, rules.min_species_size) <= self.places:
            return
        _log.info(
            "%d species of at least %d members exceed the population size of %d; "
            "using elitism = %d and min_species_size = 1 in this turn",
            species,
            max(rules.elitism, rules.min_species_size),
            self.places,
            min(rules.elitism, 1),
        )
        rules.elitism = min(rules.elitism, 1)
        rules.min_species_size = 1


def _remove_weakest(verdicts: list[Verdict], places: int) -> list[Verdict]:
    """Mark the weakest species as extinct until *places* remain; among equally weak ones, the oldest."""
    surplus = sum(not dies for _, _, dies in verdicts) - places
    result = []
    for key, species, dies in verdicts:
        loses = not dies and surplus > 0
        if loses:
            surplus -= 1
            _log.warning("removing species %d: more species than members", key)
        result.append((key, species, dies or loses))
    return result


class ExactReproduction(neat.DefaultReproduction):  # type: ignore[misc] # neat-python has no types
    """Reproduction that returns exactly the requested number of offspring."""

    def reproduce(self, config: Any, species: Any, pop_size: int, generation: int) -> dict[int, Any]:
        """Return the next generation; it is empty if every species went extinct."""
        rules = self.reproduction_config
        configured = rules.elitism, rules.min_species_size
        self.stagnation.places = pop_size
        try:
            offspring: dict[int, Any] = super().reproduce(config, species, pop_size, generation)
        finally:
            rules.elitism, rules.min_species_size = configured
        self.ancestors.clear()  # never read, and grows in every turn
        return offspring

    def _adjust_spawn_exact(
        self, spawn_amounts: list[int], pop_size: int, min_species_size: int
    ) -> list[int]:
        return fit_exactly(spawn_amounts, pop_size, min_species_size)


def fit_exactly(amounts: list[int], size: int, least: int) -> list[int]:
    """Return *amounts* adjusted to the sum *size*, none below *least*.

    Each round adds 1 to amounts in ascending order, or subtracts 1 in descending order, until the sum fits.
    neat-python stops after one round of subtraction.

    Args:
        amounts: Requested members of each species, each at least *least*.
        size: Total number of members, at least *least* for each species.
        least: Minimum number of members of a species.
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
