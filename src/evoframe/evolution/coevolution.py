"""The loop of cooperative coevolution: populations take turns and are evaluated with collaborators."""

from __future__ import annotations

import contextlib
import functools
import itertools
import time
from collections import ChainMap, deque
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from typing import Any, Self

import attrs
from attrs.validators import ge

from evoframe.contract import BestPair, Design, Pair, Score, Turn, Workload
from evoframe.documents import structure
from evoframe.errors import ComponentError
from evoframe.evolution.collaboration import Collaboration
from evoframe.evolution.credit import Judge, scored_meetings
from evoframe.evolution.decoding import Meeting, decoded_designs
from evoframe.evolution.drafts import Drafts
from evoframe.evolution.evaluation import Evaluator
from evoframe.evolution.measures import Measures
from evoframe.evolution.meetings import first_meetings, meetings_with
from evoframe.evolution.population import Population
from evoframe.evolution.roles import Roles
from evoframe.evolution.timing import Timing

__all__ = ["Coevolution"]


@attrs.define
class Coevolution:
    """The loop of a run; iterating over it executes the turns, without input or output.

    In the initial turn, every individual is evaluated with every individual of each other population; its
    fitness is the arithmetic mean of its scores. In each following turn, one population reproduces (with
    parallel timing: all), and all its members are evaluated with collaborators from the other populations,
    whose fitness does not change (docs/experiment.md, "The loop"). If the fittest individuals of all
    populations were not paired in the last turn, the final pair is scored in a turn of its own, without
    changing any fitness.

    Collaborators from several other populations are combined by position: the i-th of each.

    Attributes:
        populations: At least one, in the order of turns and of decoding.
        collaborations: For each population, the choice of its collaborators.
        judges: For each population, the assignment of its fitness.
        evaluator: Scores designs.
        timing: The order in which populations reproduce.
        measures: Measures for evolvers that want them.
        roles: Roles of designs that no population evolves.
        drafts: Random initial populations, if some start with the fittest of several.
        on_simulating: Called in each turn while the workers simulate, to complete what concerns the turn
            before. The populations are those of that turn, except the ones that have reproduced since.
        turn: Index of the latest turn; -1 before the first.
        best_score: Best score of a pair so far.
    """

    populations: tuple[Population, ...]
    collaborations: tuple[Collaboration, ...]
    judges: tuple[Judge, ...]
    evaluator: Evaluator
    timing: Timing
    measures: Measures
    roles: Roles = attrs.field(factory=Roles)
    drafts: Drafts = attrs.field(factory=Drafts)
    on_simulating: Callable[[], None] = attrs.field(default=lambda: None, init=False)
    turn: int = attrs.field(default=-1, init=False)
    best_score: float | None = attrs.field(default=None, init=False)
    _fittest_have_met: bool = attrs.field(default=False, init=False)
    _judged: int = attrs.field(default=0, init=False)
    _clocks: tuple[float, ...] = attrs.field(init=False)
    _ended: dict[str, Any] = attrs.field(factory=dict, init=False)
    _recent: deque[dict[tuple[int, ...], Score]] = attrs.field(init=False)

    def __attrs_post_init__(self) -> None:
        self._clocks = (0.0,) * len(self.populations)
        # Survivors of a population meet the same collaborators again if these are still the chosen ones, so
        # that the turn in which the population was last evaluated is the oldest one worth keeping.
        self._recent = deque(maxlen=sum(self.timing.weights))
        self._ended = self._state_of_turn()

    @property
    def length(self) -> int:
        """Number of turns in which a population reproduces."""
        return self.timing.length

    @property
    def finished(self) -> bool:
        """True if all turns are complete."""
        return self.turn >= self.length and self._fittest_have_met

    @property
    def reproducing_next(self) -> tuple[str, ...]:
        """Names of the populations that reproduce in the next turn; none after the last one."""
        return tuple(self.populations[index].name for index in self._next())

    def _next(self) -> tuple[int, ...]:
        if not 0 <= self.turn < self.length:
            return ()
        return self.timing.reproducing(self.turn + 1, self._clocks)

    def __iter__(self) -> Iterator[Turn]:
        """Yield the initial turn, the turns of the populations, and if required that of the final pair."""
        if self.turn < 0:
            yield self._initial_turn()
        while self.turn < self.length:
            yield self._take_turn(self._next())
        if not self._fittest_have_met:
            yield self._final_turn()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def fittest_pair(self) -> Pair:
        """Return the fittest of each population as a pair; after the last turn, its score is known."""
        [pair] = self._pairs(self._scores([self._fittest()]))
        return pair

    def state(self, changed: Collection[str] | None = None) -> dict[str, Any]:
        """Return everything needed to continue after the latest turn, as JSON values.

        Args:
            changed: Names of the populations to include; by default all.
        """
        wanted = [p for p in self.populations if changed is None or p.name in changed]
        return {**self._ended, **{f"population/{p.name}": p.state() for p in wanted}}

    def restore(self, state: Mapping[str, Any]) -> None:
        """Continue from the result of :meth:`state`, bit for bit as without an interruption.

        Raises:
            KeyError: A part of the state is missing.
            StructureError: A part of the state is invalid; names its keys.
            ValueError: An evolver, a strategy or a random stream rejects its state.
        """
        loop = structure(state["loop"], _Loop, ("loop",))
        self.turn, self.best_score = loop.turn, loop.best_score
        self._fittest_have_met, self._judged = loop.fittest_have_met, loop.judged
        if self.timing.kind == "asynchronous":
            self._clocks = loop.clocks
        self._recent.clear()
        for population in self.populations:
            population.restore(state[f"population/{population.name}"])
        for collaboration in self.collaborations:
            if collaboration.observes:
                collaboration.restore(state[_part(collaboration)])
        if self.roles.roles:
            self.roles.restore(state["roles"])
        self.roles.begin_turn(self.turn)
        self._ended = self._state_of_turn()

    def close(self) -> None:
        """Shut down the workers."""
        self.evaluator.close()

    def _initial_turn(self) -> Turn:
        started = time.perf_counter()
        simulated = self.evaluator.simulations
        if self.drafts.populations:
            self.roles.begin_turn(0)
            signs = [judge.sign for judge in self.judges]
            self.drafts.seed(self.populations, signs, self.roles, self.evaluator)
        for population in self.populations:
            population.reproduce()
        met = first_meetings([len(population.genomes) for population in self.populations])
        judged = tuple(range(len(self.populations)))
        return self._complete_turn({judged: met}, started, simulated=simulated, first=True)

    def _take_turn(self, reproducing: Sequence[int]) -> Turn:
        started = time.perf_counter()
        for population in self.populations:
            population.begin_turn()
        for index in reproducing:
            self.populations[index].reproduce(keep_candidates=len(reproducing) > 1)
        met: dict[tuple[int, ...], list[Meeting]] = {}
        for index in reproducing:
            met[(index,)] = meetings_with(index, self.collaborations[index].teams())
        return self._complete_turn(met, started)

    def _final_turn(self) -> Turn:
        for population in self.populations:
            population.begin_turn()
        return self._complete_turn({(): [self._fittest()]}, time.perf_counter())

    def _fittest(self) -> Meeting:
        return tuple(population.fittest() for population in self.populations)

    def _complete_turn(
        self,
        meetings: Mapping[tuple[int, ...], Sequence[Meeting]],
        started: float,
        *,
        simulated: int | None = None,
        first: bool = False,
    ) -> Turn:
        """Score the meetings of a turn, and set the fitness of the populations that are judged by them.

        Args:
            meetings: Indices of populations -> the unique meetings in which their members are evaluated.
            started: When the turn started.
            simulated: Number of simulations at that time; by default the present one.
            first: Whether it is the initial turn.
        """
        before = self.evaluator.simulations if simulated is None else simulated
        self.roles.begin_turn(self.turn + 1)
        self._judged = min((index for indices in meetings for index in indices), default=0)
        union = list(dict.fromkeys(itertools.chain.from_iterable(meetings.values())))
        scores = self._scores(union, self._while_simulating)
        judged = [index for indices in meetings for index in indices]
        self._judge(meetings, scores, first=first)
        pairs = self._pairs(scores)
        if not self.roles.are_redrawn:
            self._recent.append({p.genomes: score for p, score in zip(pairs, scores.values(), strict=True)})
        self.turn += 1
        self._clocks = self.timing.advanced(self._clocks, self.turn, judged, len(scores))
        self._fittest_have_met = self._fittest() in scores
        best_pair = self._best_pair(scores)
        self._show_strategies(scores)
        self._ended = self._state_of_turn()
        return Turn(
            index=self.turn,
            reports=tuple(self.populations[index].report() for index in judged),
            pairs=pairs,
            best_pair=best_pair,
            workload=Workload(
                pairs=len(scores),
                simulations=self.evaluator.simulations - before,
                seconds=time.perf_counter() - started,
            ),
        )

    def _while_simulating(self) -> None:
        """Complete what concerns the turn before, and breed the population that reproduces in the next."""
        self.on_simulating()
        if self.timing.kind != "sequential" or not 0 <= self.turn < self.length - 1:
            return
        [now], [then] = (self.timing.reproducing(turn, ()) for turn in (self.turn + 1, self.turn + 2))
        if then != now:
            self.populations[then].breed()

    def _judge(
        self,
        meetings: Mapping[tuple[int, ...], Sequence[Meeting]],
        scores: Mapping[Meeting, Score],
        *,
        first: bool,
    ) -> None:
        """Set the fitness of the members of populations by the scores of the meetings that judge them."""
        own = {
            index: scores if len(met) == len(scores) else {meeting: scores[meeting] for meeting in met}
            for indices, met in meetings.items()
            for index in indices
        }
        # All before any is set: no credit depends on the order of the populations.
        judgements = {index: self._judgement(index, seen, first=first) for index, seen in own.items()}
        for index, judgement in judgements.items():
            self.populations[index].judge(*judgement)
            self.collaborations[index].note_collaborators(own[index], self.populations)

    def _judgement(
        self, index: int, scores: Mapping[Meeting, Score], *, first: bool
    ) -> tuple[list[float | None], float | None, dict[str, list[float | None]]]:
        """Return fitness, floor and measures of the members of a population: see :meth:`Population.judge`."""
        judge = self.judges[index]
        seen = functools.partial(scored_meetings, self.turn + 1, self.populations, scores, judge.sign)
        fitness = judge.fitness(self.populations[index], index, scores, seen, first=first)
        return fitness, judge.floor(scores), self._measured(index, scores, first=first)

    def _measured(
        self, index: int, scores: Mapping[Meeting, Score], *, first: bool
    ) -> dict[str, list[float | None]]:
        """Return the measures that the evolver of a population wants."""
        population = self.populations[index]
        if not population.wants:
            return {}
        met: dict[int, Meeting] = {}
        for meeting in scores:
            met.setdefault(meeting[index], meeting)
        ordered = [met[position] for position in range(len(population.members))]
        designs = list(self._decoded(ordered))
        measured: dict[str, list[float | None]] = {}
        for name in population.wants:
            values = self.measures.of(population, name, designs)
            if values is None:
                measured[name] = self.judges[index].measure(population, index, scores, name, first=first)
            else:
                measured[name] = [*values]
        return measured

    def _show_strategies(self, scores: Mapping[Meeting, Score]) -> None:
        """Show a turn to the strategies with a memory."""
        for collaboration, judge in zip(self.collaborations, self.judges, strict=True):
            if collaboration.observes:
                collaboration.observe(scored_meetings(self.turn, self.populations, scores, judge.sign))

    def _state_of_turn(self) -> dict[str, Any]:
        """Return the state after the turn that has just ended, without that of populations."""
        loop = attrs.asdict(
            _Loop(self.turn, self.best_score, self._fittest_have_met, self._clocks, self._judged)
        )
        needed = {"clocks": self.timing.kind == "asynchronous", "judged": self.roles.are_redrawn}
        parts: dict[str, Any] = {
            "loop": {key: value for key, value in loop.items() if needed.get(key, True)},
            **{_part(collaboration): collaboration.state() for collaboration in self.collaborations},
            "roles": self.roles.state(),
        }
        return {part: state for part, state in parts.items() if state is not None}

    def _scores(
        self, meetings: Collection[Meeting], on_simulating: Callable[[], None] = lambda: None
    ) -> dict[Meeting, Score]:
        """Return the scores of unique meetings; pairs of recent turns are not evaluated again."""
        recent = dict(ChainMap(*self._recent))  # an id stands for one genome
        pairs = zip(meetings, self._ids(meetings), strict=True)
        known = {meeting: recent[ids] for meeting, ids in pairs if ids in recent}
        # Sorted, so that designs with the same first members share a batch.
        unknown = sorted(set(meetings) - known.keys())
        with self._naming_individuals(unknown):
            designs = self._decoded(unknown)
            scores = self.evaluator.evaluate(designs, len(unknown), on_simulating)
        known.update(zip(unknown, scores, strict=True))
        return {meeting: known[meeting] for meeting in meetings}

    def _decoded(self, meetings: Iterable[Meeting]) -> Iterator[Design]:
        return decoded_designs(self.populations, meetings, self.roles, self._judged)

    def _ids(self, meetings: Iterable[Meeting]) -> Iterator[tuple[int, ...]]:
        """Yield the ids of the genomes of each meeting."""
        ids = [[member.id for member in population.present] for population in self.populations]
        return (tuple(map(list.__getitem__, ids, meeting)) for meeting in meetings)

    @contextlib.contextmanager
    def _naming_individuals(self, meetings: Sequence[Meeting]) -> Iterator[None]:
        """Add the names of individuals to an error that contains only the indices of their *meetings*."""
        try:
            yield
        except ComponentError as error:
            if error.concerns:
                raise
            met = (zip(self.populations, meetings[place], strict=True) for place in error.places)
            names = (" with ".join(p.called(position) for p, position in pairs) for pairs in met)
            raise attrs.evolve(error, concerns="; ".join(names)) from error

    def _pairs(self, scores: Mapping[Meeting, Score]) -> tuple[Pair, ...]:
        return tuple(
            Pair(ids, score.value, score.diverged_at)
            for ids, score in zip(self._ids(scores), scores.values(), strict=True)
        )

    def _best_pair(self, scores: Mapping[Meeting, Score]) -> BestPair | None:
        """Return the best pair of this turn if it exceeds all earlier ones; the earliest wins ties."""
        best: Meeting | None = None
        for meeting, score in scores.items():
            if score.value is not None and (self.best_score is None or score.value > self.best_score):
                self.best_score, best = score.value, meeting
        if best is None or self.best_score is None:
            return None
        [design] = self._decoded([best])
        chosen = list(zip(self.populations, best, strict=True))
        return BestPair(
            turn=self.turn,
            score=self.best_score,
            genome_ids={population.name: population.present[i].id for population, i in chosen},
            genomes={population.name: population.dump(i) for population, i in chosen},
            design=design,
        )


def _part(collaboration: Collaboration) -> str:
    """Return the name of the part of the state with the memory of a strategy."""
    return f"collaboration/{collaboration.own.name}"


@attrs.frozen
class _Loop:
    """The part of the state that is independent of the populations."""

    turn: int = attrs.field(validator=ge(-1))
    best_score: float | None
    fittest_have_met: bool
    clocks: tuple[float, ...] = ()
    judged: int = 0
