"""Toy components with the optional capabilities of the contract, and configurations that use them.

They complete the plugin of :mod:`toys`, whose genomes, designs and scores are numbers.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, ClassVar

import attrs
import numpy as np
import toys
from numpy.typing import NDArray

from evoframe import (
    Archived,
    ArrayType,
    Choice,
    Chosen,
    CollaborationRun,
    CollaborationStrategy,
    ConfigurationError,
    Design,
    Judged,
    Member,
    Outcome,
    Record,
    ScoredMeetings,
    Simulator,
    hookimpl,
    started,
)


def ranked(members: Sequence[Member]) -> list[int]:
    """Return the indices of members from the fittest down; diverged ones last."""
    return sorted(range(len(members)), key=lambda i: (members[i].diverged, -(members[i].fitness or 0.0), i))


@attrs.frozen
class Archiving:
    """Chooses the fittest member, and one of the champions of earlier turns at random."""

    capacity: int = 3

    def size(self, n_members: int) -> int:
        if n_members < 2:
            raise ConfigurationError(f"2 collaborators of {n_members} members")
        return 2

    def select(self, members: Sequence[Member], rng: np.random.Generator) -> NDArray[np.intp]:
        del rng
        return np.array(ranked(members)[:2], dtype=np.intp)

    def start(self, population: str, other: str) -> ArchivingRun:
        return ArchivingRun(self.capacity, population, other)


@attrs.define
class ArchivingRun:
    capacity: int
    population: str
    other: str
    archive: list[Archived] = attrs.field(factory=list)
    seen: int = 0

    def choose(
        self, judged: Sequence[Judged], members: Sequence[Member], rng: np.random.Generator
    ) -> Sequence[Sequence[Choice]]:
        best, second = ranked(members)[:2]
        others = [each for each in self.archive if each.member.id != members[best].id]
        chosen: Choice = others[int(rng.integers(len(others)))] if others else second
        return [[best, chosen]] * len(judged)

    def observe(self, meetings: ScoredMeetings, genome: Callable[[int], Any]) -> None:
        self.seen += 1
        column = meetings.populations.index(self.other)
        present = meetings.members[column][: meetings.present[column]]
        champion = ranked(present)[0]
        kept = [each for each in self.archive if each.member.id != present[champion].id]
        self.archive = [*kept, Archived(present[champion], genome(champion))][-self.capacity :]

    def state(self) -> Any:
        archive = [{"member": attrs.asdict(each.member), "genome": each.genome} for each in self.archive]
        return {"of": [self.population, self.other], "seen": self.seen, "archive": archive}

    def restore(self, state: Any) -> None:
        if state["of"] != [self.population, self.other]:
            raise ValueError(f"expected the memory of {[self.population, self.other]}, found {state['of']}")
        self.seen = state["seen"]
        self.archive = [Archived(Member(**each["member"]), each["genome"]) for each in state["archive"]]


@attrs.frozen
class Loyal:
    """Chooses for each individual the first of its last collaborators that is left, and a random member."""

    def size(self, n_members: int) -> int:
        if n_members < 2:
            raise ConfigurationError(f"2 collaborators of {n_members} members")
        return 2

    def select(self, members: Sequence[Member], rng: np.random.Generator) -> NDArray[np.intp]:
        return rng.permutation(len(members))[:2].astype(np.intp)

    def select_each(
        self, judged: Sequence[Judged], members: Sequence[Member], rng: np.random.Generator
    ) -> NDArray[np.intp]:
        places = {member.id: index for index, member in enumerate(members)}
        rows = []
        for each in judged:
            known = [places[key] for key in each.collaborators if key in places]
            drawn = rng.permutation(len(members)).tolist()
            rows.append(list(dict.fromkeys([*known[:1], *drawn]))[:2])
        return np.array(rows, dtype=np.intp)


@attrs.frozen
class Alternating:
    """Chooses one collaborator or two, depending on the number of turns that it has seen."""

    def size(self, n_members: int) -> int:
        return min(2, n_members)

    def sizes(self, n_members: int) -> Sequence[int]:
        return range(1, min(2, n_members) + 1)

    def select(self, members: Sequence[Member], rng: np.random.Generator) -> NDArray[np.intp]:
        del rng
        return np.array(ranked(members)[:2], dtype=np.intp)

    def start(self, population: str, other: str) -> AlternatingRun:
        del population, other
        return AlternatingRun()


@attrs.define
class AlternatingRun:
    seen: int = 0

    def choose(
        self, judged: Sequence[Judged], members: Sequence[Member], rng: np.random.Generator
    ) -> Sequence[Sequence[Choice]]:
        del rng
        return [ranked(members)[: 1 + self.seen % 2]] * len(judged)

    def observe(self, meetings: ScoredMeetings, genome: Callable[[int], Any]) -> None:
        del meetings, genome
        self.seen += 1

    def state(self) -> Any:
        return self.seen

    def restore(self, state: Any) -> None:
        self.seen = state


@attrs.frozen
class Everyone:
    """Chooses all members."""

    def size(self, n_members: int) -> int:
        return n_members

    def select(self, members: Sequence[Member], rng: np.random.Generator) -> NDArray[np.intp]:
        del rng
        return np.arange(len(members), dtype=np.intp)


@attrs.frozen
class Outer:
    """Chooses like its first option; the other ones show lists of components, and ones that may be missing.

    Attributes:
        inner: The strategy that chooses.
    """

    inner: Chosen[CollaborationStrategy]
    more: tuple[Chosen[CollaborationStrategy], ...] = ()
    spare: Chosen[CollaborationStrategy] | None = None

    def size(self, n_members: int) -> int:
        return self.inner.component.size(n_members)

    def select(self, members: Sequence[Member], rng: np.random.Generator) -> NDArray[np.intp]:
        return self.inner.component.select(members, rng)

    def start(self, population: str, other: str) -> CollaborationRun:
        return started(self.inner.component, population, other)


@attrs.frozen
class Wanting(toys.Drift):
    """Selects by the sum of the fitness and of the measures that it wants."""

    wants: tuple[str, ...] = ("novelty",)

    def start(self, inputs: int, outputs: int, size: int, rng: np.random.Generator) -> toys.DriftRun:
        assert (inputs, outputs) == (1, 1)
        return WantingRun(self.step, size, rng, wants=self.wants)


@attrs.define
class WantingRun(toys.DriftRun):
    wants: tuple[str, ...] = ()
    told: dict[str, NDArray[np.float64]] = attrs.field(factory=dict)
    seeds: list[float] = attrs.field(factory=list)

    def ask(self) -> Sequence[float]:
        if self.fitness:
            merits = [sum(values) for values in zip(self.fitness, *self.told.values(), strict=True)]
            order = sorted(range(self.size), key=lambda i: -merits[i])
            self.fitness = [float(self.size - order.index(i)) for i in range(self.size)]
        first = not self.values
        asked = super().ask()
        if first and self.seeds:
            self.values[: len(self.seeds)] = self.seeds
            return list(self.values)
        return asked

    def tell(self, fitness: NDArray[np.float64], measures: Mapping[str, NDArray[np.float64]]) -> None:
        super().tell(fitness, measures)
        if set(measures) != set(self.wants):
            raise ValueError(f"expected the measures {self.wants}, found {list(measures)}")
        self.told = dict(measures)

    def load(self, dumped: Any) -> float:
        if not isinstance(dumped, float):
            raise ValueError(f"expected a number, found {dumped!r}")  # noqa: TRY004 - as the protocol demands
        return dumped

    def seed(self, genomes: Sequence[float]) -> None:
        self.seeds = list(genomes)

    def state(self) -> Any:
        return {**super().state(), "told": {name: values.tolist() for name, values in self.told.items()}}

    def restore(self, state: Any) -> None:
        super().restore(state)
        self.told = {name: np.array(values) for name, values in state["told"].items()}


@attrs.frozen
class Measuring(toys.Product):
    """Measures the sum of the squares of all numbers, and simulates at most two designs at once."""

    measures: ClassVar[tuple[str, ...]] = ("energy",)
    batch_size: ClassVar[int] = 2

    def simulate(self, designs: Sequence[Design], record: Record) -> Sequence[Outcome]:
        assert len(designs) <= self.batch_size
        outcomes = super().simulate(designs, record)
        energies = [sum(float(a[0]) ** 2 for a in design.roles.values()) for design in designs]
        return [
            outcome if outcome.diverged_at else attrs.evolve(outcome, measures={"energy": energy})
            for outcome, energy in zip(outcomes, energies, strict=True)
        ]


@attrs.frozen
class Second(toys.Value):
    """Has a second score: the negative size of the first."""

    measures: ClassVar[tuple[str, ...]] = ("smallness",)

    def measure(self, outcome: Outcome) -> Mapping[str, float]:
        return {"smallness": -abs(self.score(outcome))}


@attrs.frozen
class Negated(toys.Value):
    """The negative product."""

    def score(self, outcome: Outcome) -> float:
        return -super().score(outcome)


@attrs.frozen
class Typed(toys.Number):
    """Declares the types of its arrays, and measures the number that it provides."""

    dtype: str = "float64"
    length: int = 1

    @property
    def array_types(self) -> Mapping[str, ArrayType]:
        own = ArrayType(self.dtype, (self.length,))
        return {self.role: own, **dict.fromkeys(self.needs, own)}

    @property
    def measures(self) -> tuple[str, ...]:
        return (f"size-of-{self.role}",)

    def measure(self, design: Design) -> Mapping[str, float]:
        return {f"size-of-{self.role}": abs(float(design.roles[self.role][0]))}


@attrs.frozen
class Constant:
    """The same number in each design."""

    role: str = "r"
    value: float = 2.0
    needs: tuple[str, ...] = ()

    @property
    def requires(self) -> tuple[str, ...]:
        return self.needs

    @property
    def provides(self) -> tuple[str, ...]:
        return (self.role,)

    def start(self, simulator: Simulator) -> Constant:
        del simulator
        return self

    def fill(self, design: Design, rng: np.random.Generator) -> Design:
        del rng
        return design.with_role(self.role, np.array([self.value]))

    def state(self) -> Any:
        return self.value

    def restore(self, state: Any) -> None:
        if state != self.value:
            raise ValueError(f"the number was {state}, and is {self.value}")


@attrs.frozen
class Random(Constant):
    """A random number between 0 and 1."""

    def fill(self, design: Design, rng: np.random.Generator) -> Design:
        return design.with_role(self.role, rng.random(1))


@hookimpl
def evoframe_strategies() -> Mapping[str, type[Any]]:
    return {
        "toy-archiving": Archiving,
        "toy-loyal": Loyal,
        "toy-alternating": Alternating,
        "toy-everyone": Everyone,
        "toy-outer": Outer,
    }


@hookimpl
def evoframe_encoders() -> Mapping[str, type[Any]]:
    return {"toy-typed": Typed}


@hookimpl
def evoframe_evolvers() -> Mapping[str, type[Any]]:
    return {"toy-wanting": Wanting}


@hookimpl
def evoframe_simulators() -> Mapping[str, type[Any]]:
    return {"toy-measuring": Measuring}


@hookimpl
def evoframe_objectives() -> Mapping[str, type[Any]]:
    return {"toy-second": Second, "toy-negated": Negated}


@hookimpl
def evoframe_roles() -> Mapping[str, type[Any]]:
    return {"toy-constant": Constant, "toy-random": Random}


THIRD = """
[populations.c]
size = 4
encoder = { name = "toy-number", role = "c" }
evolver = "toy-drift"
"""
THREE = toys.CONFIGURATION.replace("[collaboration]", f"{THIRD}\n[collaboration]")
ONE = (
    toys.CONFIGURATION[: toys.CONFIGURATION.index("[populations.b]")]
    + toys.CONFIGURATION[toys.CONFIGURATION.index("[collaboration]") :]
)

_WANTING = "populations.{}.evolver={{name='toy-wanting', wants=[{}]}}"
_LOADING = [_WANTING.format("a", ""), _WANTING.format("b", "")]

VARIANTS: Mapping[str, tuple[str, Sequence[str]]] = {
    "sequential": (toys.CONFIGURATION, []),
    "random choice": (toys.CONFIGURATION, ["collaboration=toy-drawn"]),
    "final pair": (toys.CONFIGURATION, ["collaboration=toy-last"]),
    "archive": (toys.CONFIGURATION, ["collaboration=toy-archiving", *_LOADING]),
    "archive and final pair": (
        toys.CONFIGURATION,
        ["populations.a.collaboration=toy-archiving", "populations.b.collaboration=toy-last", *_LOADING],
    ),
    "each": (toys.CONFIGURATION, ["collaboration=toy-loyal"]),
    "own strategies": (
        toys.CONFIGURATION,
        ["populations.a.collaboration=toy-loyal", "populations.b.collaboration=toy-archiving", *_LOADING],
    ),
    "numbers that change": (toys.CONFIGURATION, ["collaboration=toy-alternating"]),
    "nested": (
        toys.CONFIGURATION,
        ["collaboration={name='toy-outer', inner='toy-archiving', more=['toy-last']}", *_LOADING],
    ),
    "parallel": (toys.CONFIGURATION, ["run.timing=parallel"]),
    "parallel archive": (
        toys.CONFIGURATION,
        ["run.timing=parallel", "collaboration=toy-archiving", *_LOADING],
    ),
    "parallel each": (toys.CONFIGURATION, ["run.timing=parallel", "collaboration=toy-loyal"]),
    "asynchronous": (toys.CONFIGURATION, ["run.timing=asynchronous"]),
    "asynchronous archive": (
        toys.CONFIGURATION,
        ["run.timing=asynchronous", "populations.b.turns=2", "collaboration=toy-archiving", *_LOADING],
    ),
    "weighted": (toys.CONFIGURATION, ["populations.a.turns=2", "run.generations=3"]),
    "credit": (toys.CONFIGURATION, ["populations.a.aggregator=toy-share", "populations.b.goal=minimize"]),
    "three": (THREE, []),
    "three parallel": (THREE, ["run.timing=parallel", "collaboration=toy-loyal"]),
    "three archive": (
        THREE,
        ["collaboration=toy-archiving", *_LOADING, _WANTING.format("c", "'age'"), "populations.c.turns=2"],
    ),
    "one": (ONE, []),
    "one with a role for each": (ONE, ["roles.r={provider='toy-random', draw='individual'}"]),
    "one with a role for each turn": (ONE, ["roles.r={provider='toy-random', draw='turn'}"]),
    "one with a role after it": (
        ONE,
        ["roles.r={provider={name='toy-random', needs=['a']}, draw='individual'}"],
    ),
    "roles in turns": (
        toys.CONFIGURATION,
        ["roles.r={provider='toy-random', draw='individual'}", "collaboration=toy-loyal"],
    ),
    "role of a run": (toys.CONFIGURATION, ["roles.r={provider='toy-random'}"]),
    "measures": (
        toys.CONFIGURATION,
        [
            "simulator=toy-measuring",
            "objective=toy-second",
            "populations.a.encoder={name='toy-typed', role='a'}",
            _WANTING.format("a", "'novelty', 'energy', 'smallness'"),
            _WANTING.format("b", "'size-of-a', 'age'"),
        ],
    ),
    "measures with divergence": (
        toys.CONFIGURATION,
        [
            "simulator={name='toy-measuring', limit=0.15}",
            _WANTING.format("a", "'energy'"),
            _WANTING.format("b", "'energy'"),
        ],
    ),
}
"""Name -> text of a configuration, and overrides."""
