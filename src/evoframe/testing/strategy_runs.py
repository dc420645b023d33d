"""The laws of the runs of collaboration strategies, tested in simulated turns."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from typing import Any, ClassVar

import numpy as np
from hypothesis import strategies as st

from evoframe.contract import (
    Archived,
    Choice,
    CollaborationRun,
    CollaborationStrategy,
    Member,
    SupportsMemory,
    sizes_of,
    started,
)
from evoframe.testing.components import ComponentContract
from evoframe.testing.encounters import OTHER, POPULATION, MadeChoice, World
from evoframe.testing.laws import (
    JUNK,
    accepted,
    damaged_at,
    for_all,
    global_random_state_untouched,
    places_in,
    refusal,
)

__all__ = ["StrategyRunLaws"]

_SEEDS = st.integers(0, 2**32 - 1)
_FEW = 20  # examples of a law that plays several turns in each


class StrategyRunLaws(ComponentContract[CollaborationStrategy]):
    """The laws of a :class:`~evoframe.CollaborationRun`, which are part of the contract of strategies.

    In each simulated turn, the run chooses for a part of a population among all members of another one, and
    for the rest among some of them. Then it observes the turn, and one of the other population.

    Attributes:
        population_sizes: Sizes of populations to test, except those that ``size`` refuses.
        turns: Number of turns of the choosing population in a simulated run.
    """

    protocol = CollaborationStrategy
    population_sizes: ClassVar[range] = range(1, 17)
    turns: ClassVar[int] = 6

    def test_it_starts_a_run(self) -> None:
        """``start`` returns a ``CollaborationRun`` with every method of the protocol."""
        assert isinstance(self.start(), CollaborationRun), (
            "start() must return a CollaborationRun; a method is missing"
        )

    def test_a_run_chooses_members_and_archived_individuals(self) -> None:
        """A choice is the index of a member, or an archived individual that is not one of the members."""
        self._in_simulated_runs(_assert_valid)

    def test_a_run_chooses_as_many_as_declared(self) -> None:
        """``choose`` returns a row for each individual, and its length is one of the declared numbers."""
        self._in_simulated_runs(self._assert_as_declared)

    def test_a_run_chooses_nobody_twice_for_an_individual(self) -> None:
        """Collaborators of an individual are different, archived ones included."""
        self._in_simulated_runs(_assert_different)

    def test_a_run_chooses_nobody_diverged_while_a_clean_member_is_left(self) -> None:
        """Individuals with a diverged simulation are chosen last, archived ones included."""
        self._in_simulated_runs(_assert_clean_first)

    def test_archived_genomes_are_those_that_the_run_has_seen(self) -> None:
        """The genome of an archived individual is what ``genome`` returned for it in ``observe``."""

        def law(seed: int, n: int) -> None:
            def see(made: MadeChoice) -> None:
                for one in _archived(made):
                    known = world.genomes.get(one.member.id)
                    assert one.genome == known, (
                        f"genome() returned {known} for the individual {one.member.id}, found {one.genome}"
                    )

            world = self._world(n, seed, see)
            self._play(world, self.start(), seed)

        self._for_few(law)

    def test_the_same_random_state_gives_the_same_run(self) -> None:
        """Choices depend only on what the methods of a run receive."""

        def law(seed: int, n: int) -> None:
            with global_random_state_untouched():
                first, second = (self._history(self.start(), n, seed) for _ in range(2))
            assert first == second, (
                "two runs that see the same choose differently; draw from the given generator only, "
                "and keep all memory in the run"
            )

        self._for_few(law)

    def test_a_state_is_json(self) -> None:
        """``state`` returns a value that is equal after a round trip through JSON text."""

        def law(seed: int, n: int) -> None:
            run = self.start()
            for _ in self._turns(self._world(n, seed, _ignore), run, seed):
                state = run.state()
                assert json.loads(_text(state)) == state, (
                    "state() must return values that survive a round trip through JSON: lists, not tuples"
                )

        self._for_few(law)

    def test_a_restored_run_continues_bit_for_bit(self) -> None:
        """A run that is replaced after every turn by one with its state makes the same choices."""

        def law(seed: int, n: int) -> None:
            made: list[Any] = []
            world, rng = self._world(n, seed, lambda one: made.append(one.as_json())), _generator(seed)
            run = self.start()
            for _ in range(self.turns):
                world.play(run, rng)
                state = _text(run.state())
                run = self.start()
                run.restore(json.loads(state))
                assert _text(run.state()) == state, "state() must equal the restored state"
            assert made == self._history(self.start(), n, seed), "a restored run chooses differently"

        self._for_few(law)

    def test_a_damaged_state_is_refused_by_a_value_error(self) -> None:
        """A damaged state gives a ``ValueError``, or a run that keeps the laws of choices."""

        def law(seed: int, n: int, junk: Any, data: st.DataObject) -> None:
            run, world = self.start(), self._world(n, seed, _ignore)
            self._play(world, run, seed)
            state = json.loads(_text(run.state()))
            place = data.draw(st.sampled_from(list(places_in(state))), label="damaged place")
            restored = self.start()
            try:
                restored.restore(damaged_at(place, state, junk))
            except ValueError:
                return
            world.see = self._assert_lawful
            self._play(world, restored, seed)

        if isinstance(self.component, SupportsMemory):
            for_all(law, seed=_SEEDS, n=self._accepted_sizes(), junk=JUNK, data=st.data())

    def start(self) -> CollaborationRun:
        """Start a run of the strategy."""
        return started(self.component, POPULATION, OTHER)

    def _accepted_sizes(self) -> st.SearchStrategy[int]:
        return st.sampled_from(accepted(self.component.size, self.population_sizes))

    def _in_simulated_runs(self, check: Callable[[MadeChoice], None]) -> None:
        """Test *check* with every choice of simulated runs."""
        self._for_few(lambda seed, n: self._play(self._world(n, seed, check), self.start(), seed))

    def _for_few(self, law: Callable[[int, int], None]) -> None:
        for_all(law, _FEW, seed=_SEEDS, n=self._accepted_sizes())

    def _world(self, n: int, seed: int, see: Callable[[MadeChoice], None]) -> World:
        def accepts(n_members: int) -> bool:
            return refusal(self.component.size, n_members) is None

        return World(n, accepts, see, np.random.default_rng([seed, 1]))

    def _turns(self, world: World, run: CollaborationRun, seed: int) -> Iterator[None]:
        """Play all turns; yield after each."""
        rng = _generator(seed)
        for _ in range(self.turns):
            world.play(run, rng)
            yield

    def _play(self, world: World, run: CollaborationRun, seed: int) -> None:
        for _ in self._turns(world, run, seed):
            pass

    def _history(self, run: CollaborationRun, n: int, seed: int) -> list[Any]:
        """Return all choices of a *run* as JSON values."""
        made: list[Any] = []
        self._play(self._world(n, seed, lambda one: made.append(one.as_json())), run, seed)
        return made

    def _assert_lawful(self, made: MadeChoice) -> None:
        _assert_valid(made)
        self._assert_as_declared(made)
        _assert_different(made)
        _assert_clean_first(made)

    def _assert_as_declared(self, made: MadeChoice) -> None:
        expected, found = len(made.judged), len(made.rows)
        assert found == expected, f"expected the collaborators of {expected} individuals, found {found}"
        declared = sizes_of(self.component, len(made.members))
        for row in made.rows:
            assert len(row) in declared, (
                f"expected {' or '.join(map(str, declared))} collaborators from {len(made.members)} members, "
                f"found {len(row)}"
            )


def _assert_valid(made: MadeChoice) -> None:
    ids = {member.id for member in made.members}
    for choice in (choice for row in made.rows for choice in row):
        if isinstance(choice, Archived):
            assert choice.member.id not in ids, (
                f"the archived individual {choice.member.id} is a member: choose it by its index"
            )
        else:
            assert type(choice) is int, f"expected an int or an Archived, found {choice!r}"
            assert 0 <= choice < len(ids), f"expected indices from 0 to {len(ids) - 1}, found {choice}"


def _assert_different(made: MadeChoice) -> None:
    for row in made.rows:
        ids = [_individual(choice, made).id for choice in row]
        assert len(set(ids)) == len(ids), f"expected different individuals, found the ids {ids}"


def _assert_clean_first(made: MadeChoice) -> None:
    clean = {member.id for member in made.members if not member.diverged}
    for row in made.rows:
        individuals = [_individual(choice, made) for choice in row]
        if any(one.diverged for one in individuals):
            ids = {one.id for one in individuals}
            assert clean <= ids, (
                f"choose all clean members {sorted(clean)} before a diverged individual; found {sorted(ids)}"
            )


def _individual(choice: Choice, made: MadeChoice) -> Member:
    return choice.member if isinstance(choice, Archived) else made.members[choice]


def _archived(made: MadeChoice) -> Iterator[Archived]:
    return (choice for row in made.rows for choice in row if isinstance(choice, Archived))


def _generator(seed: int) -> np.random.Generator:
    return np.random.default_rng(seed)


def _ignore(_: MadeChoice) -> None:
    """See a choice, and do nothing."""


def _text(value: Any) -> str:
    """Return *value* as JSON text, which preserves the order of dictionaries."""
    return json.dumps(value, allow_nan=False)
