"""A plugin of toy components, which test the core without networks and physics.

A genome is a number, a design has one number for each role, and a score is their product.
"""

from __future__ import annotations

import logging
import os
import time
import tomllib
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, ClassVar

import attrs
import numpy as np
import tomli_w
from attrs import validators
from numpy.typing import NDArray

from evoframe import (
    ConfigurationError,
    Design,
    Export,
    InputError,
    Member,
    Network,
    Outcome,
    Record,
    ScoredMeetings,
    Scores,
    Variant,
    hookimpl,
)


@attrs.frozen
class Mean:
    domain: ClassVar[tuple[float, float]] = (-1e100, 1e100)

    def check(self, n: int) -> None:
        if n > 8:
            raise ConfigurationError(f"{n} scores exceed the 8 of toy-mean")

    def aggregate(self, scores: Scores) -> float:
        return float(np.mean(np.sort(scores)))


@attrs.frozen
class Share:
    """Credits an individual with its share of all scores of the turn."""

    def check(self, n: int) -> None:
        del n

    def credit(self, meetings: ScoredMeetings, population: int) -> NDArray[np.float64]:
        sums = [np.nansum(meetings.scores[rows]) for rows in meetings.of(population)]
        return np.array(sums) / np.nansum(meetings.scores)


@attrs.frozen
class First:
    n: int = attrs.field(default=2, validator=validators.ge(1))

    def size(self, n_members: int) -> int:
        if self.n > n_members:
            raise ConfigurationError(f"{self.n} collaborators of {n_members} members")
        return self.n

    def select(self, members: Sequence[Member], rng: np.random.Generator) -> NDArray[np.intp]:
        del rng
        order = sorted(
            range(len(members)), key=lambda i: (members[i].diverged, -(members[i].fitness or 0.0), i)
        )
        return np.array(order[: self.n], dtype=np.intp)


@attrs.frozen
class Last:
    """Chooses only the least fit member."""

    def size(self, n_members: int) -> int:
        return 1

    def select(self, members: Sequence[Member], rng: np.random.Generator) -> NDArray[np.intp]:
        del rng
        return np.array([min(range(len(members)), key=lambda i: members[i].fitness or 0.0)], dtype=np.intp)


@attrs.frozen
class Drawn:
    """Chooses two members at random."""

    def size(self, n_members: int) -> int:
        return 2

    def select(self, members: Sequence[Member], rng: np.random.Generator) -> NDArray[np.intp]:
        return rng.choice(len(members), size=2, replace=False)


@attrs.frozen
class Number:
    role: str = "a"
    needs: tuple[str, ...] = ()
    inputs: ClassVar[int] = 1
    outputs: ClassVar[int] = 1

    @property
    def requires(self) -> tuple[str, ...]:
        return self.needs

    @property
    def provides(self) -> tuple[str, ...]:
        return (self.role,)

    def decode(self, network: Network, design: Design) -> Design:
        return design.with_role(self.role, network(np.ones((1, 1)))[0])


@attrs.frozen
class Drift:
    """Keeps the fitter half of the population and adds mutants of it."""

    step: float = 0.1

    def check(self, size: int) -> None:
        if size > 100:
            raise ConfigurationError(f"toy-drift takes at most 100 members, not {size}")

    def start(self, inputs: int, outputs: int, size: int, rng: np.random.Generator) -> DriftRun:
        assert (inputs, outputs) == (1, 1)
        return DriftRun(self.step, size, rng)


@attrs.define
class DriftRun:
    step: float
    size: int
    rng: np.random.Generator
    values: list[float] = attrs.field(factory=list)
    ids: list[int] = attrs.field(factory=list)
    fitness: list[float] = attrs.field(factory=list)
    next_id: int = 1

    def ask(self) -> Sequence[float]:
        if not self.values:
            kept: list[int] = []
        else:
            kept = sorted(range(self.size), key=lambda i: -self.fitness[i])[: self.size // 2]
        values, ids = [self.values[i] for i in kept], [self.ids[i] for i in kept]
        while len(values) < self.size:
            parent = values[len(values) % len(kept)] if kept else 0.0
            values.append(parent + self.step * float(self.rng.standard_normal()))
            ids.append(self.next_id)
            self.next_id += 1
        self.values, self.ids, self.fitness = values, ids, []
        return list(values)

    def tell(self, fitness: NDArray[np.float64], measures: Mapping[str, NDArray[np.float64]]) -> None:
        del measures
        if len(fitness) != self.size or not np.isfinite(fitness).all():
            raise ValueError("one finite fitness for each genome")
        self.fitness = fitness.tolist()

    def members(self) -> Sequence[Member]:
        fitness: Sequence[float | None] = self.fitness or [None] * self.size
        return [Member(id=i, fitness=f) for i, f in zip(self.ids, fitness, strict=True)]

    def genomes(self) -> Sequence[float]:
        return list(self.values)

    def express(self, genome: float) -> Network:
        return lambda points: points * genome

    def dump(self, genome: float) -> Any:
        return genome

    def state(self) -> Any:
        return {
            "values": list(self.values),
            "ids": list(self.ids),
            "fitness": list(self.fitness),
            "next_id": self.next_id,
            "rng": self.rng.bit_generator.state,
        }

    def restore(self, state: Any) -> None:
        self.values, self.ids = list(state["values"]), list(state["ids"])
        self.fitness, self.next_id = list(state["fitness"]), state["next_id"]
        self.rng.bit_generator.state = state["rng"]


@attrs.frozen
class Product:
    """Multiplies the numbers of all roles; diverges if one exceeds a limit."""

    limit: float = 1e9
    tracks: ClassVar[tuple[str, ...]] = ("value",)
    requires: ClassVar[tuple[str, ...]] = ()

    def check(self, record: Record) -> None:
        for track in record.tracks:
            if track not in self.tracks:
                raise ConfigurationError(f"toy-product has no track '{track}'")
        if record.until > 1.0:
            raise ConfigurationError(f"toy-product ends at 1.0 s, before {record.until} s")

    def key(self, design: Design, record: Record) -> bytes:
        return repr((sorted((r, a.tolist()) for r, a in design.roles.items()), record)).encode()

    def simulate(self, designs: Sequence[Design], record: Record) -> Sequence[Outcome]:
        return [self._outcome(design) for design in designs]

    def _outcome(self, design: Design) -> Outcome:
        values = [float(array[0]) for array in design.roles.values()]
        diverged = max(map(abs, values)) > self.limit
        value = np.nan if diverged else np.prod(values)
        track = np.full((1, 3), value)
        return Outcome(np.array([1]), np.array([1.0]), {"value": track}, 1 if diverged else None)


@attrs.frozen
class Slow(Product):
    """Simulates slowly, so that a test can act during a simulation."""

    delay: float = 0.1

    def simulate(self, designs: Sequence[Design], record: Record) -> Sequence[Outcome]:
        time.sleep(self.delay)
        return super().simulate(designs, record)


@attrs.frozen
class Hanging(Product):
    """Hangs if a number is large and the file *fixed* is missing; with *once* it creates the file."""

    beyond: float = 0.1
    fixed: str = ""
    once: bool = False

    def simulate(self, designs: Sequence[Design], record: Record) -> Sequence[Outcome]:
        outcomes = super().simulate(designs, record)
        large = any(abs(float(outcome.tracks["value"][0, 0])) > self.beyond for outcome in outcomes)
        if large and not (self.fixed and Path(self.fixed).exists()):
            if self.once:
                Path(self.fixed).touch()
            time.sleep(3600)
        return outcomes


@attrs.frozen
class Unsound(Product):
    """Fails if a file is missing."""

    sound: str = ""

    def simulate(self, designs: Sequence[Design], record: Record) -> Sequence[Outcome]:
        if not Path(self.sound).exists():
            raise ZeroDivisionError("not sound")
        return super().simulate(designs, record)


@attrs.frozen
class Fatal(Product):
    """Ends its process if the file *fixed* is missing."""

    fixed: str = ""

    def simulate(self, designs: Sequence[Design], record: Record) -> Sequence[Outcome]:
        if not Path(self.fixed).exists():
            os._exit(3)
        return super().simulate(designs, record)


@attrs.frozen
class Varied(Product):
    """Has several optional capabilities: reading, settings, export and variants.

    Its files, ``.toy``, are TOML: ``designs``, and optionally ``settings``.
    """

    gain: float = attrs.field(default=1.0, validator=validators.ge(0))
    formats: ClassVar[tuple[str, ...]] = ("toy", "txt")

    def simulate(self, designs: Sequence[Design], record: Record) -> Sequence[Outcome]:
        return [self._amplified(outcome) for outcome in super().simulate(designs, record)]

    def read(self, path: Path) -> list[tuple[str, Design]]:
        designs = self._parsed(path)["designs"]
        return [(f"{path.name}[{n}]", self._design(numbers)) for n, numbers in enumerate(designs)]

    def settings_of(self, path: Path) -> Mapping[str, Any] | None:
        settings: Mapping[str, Any] | None = self._parsed(path).get("settings")
        return settings

    def export(self, design: Design, format_: str) -> Export:
        numbers = {role: float(array[0]) for role, array in design.roles.items()}
        if format_ == "txt":
            return Export(f"{numbers}\n".encode(), ("gain", "limit") if self.gain != 1 else ())
        settings = {"limit": self.limit, "gain": self.gain}
        return Export(tomli_w.dumps({"designs": [numbers], "settings": settings}).encode())

    def variants(self, design: Design, record: Record) -> Sequence[Variant]:
        draws = [
            design.with_role(role, array * factor)
            for role, array in design.roles.items()
            for factor in (0.9, 1.1)
        ]
        return [
            Variant(
                "gain off", attrs.evolve(self, gain=0.0), design, record, "ignores gain", "comes from gain"
            ),
            Variant("no room", attrs.evolve(self, limit=0.0), design, record, "fits anywhere", "needs room"),
            *(Variant("one number jittered by 10 %", self, drawn, record) for drawn in draws),
        ]

    def _amplified(self, outcome: Outcome) -> Outcome:
        return attrs.evolve(outcome, tracks={"value": self.gain * outcome.tracks["value"]})

    def _parsed(self, path: Path) -> dict[str, Any]:
        try:
            return tomllib.loads(path.read_text())
        except OSError as error:
            raise InputError(f"cannot be read: {error.strerror}", source=path) from error

    def _design(self, numbers: Mapping[str, float]) -> Design:
        return Design({role: np.array([number], dtype=np.float64) for role, number in numbers.items()})


@attrs.frozen
class Steered(Varied):
    """Draws the number ``b`` between -1 and 1, publishes two bodies, and diverges at a large product."""

    most: float = 1e9
    requires: ClassVar[tuple[str, ...]] = ("a", "b")

    def random_controller(self, design: Design, rng: np.random.Generator) -> Design:
        return design.with_role("b", rng.uniform(-1.0, 1.0, design.roles["b"].shape))

    def published(self) -> list[tuple[str, Design]]:
        return [("one", self._design({"a": 1.0, "b": 0.0})), ("two", self._design({"a": 2.0, "b": 0.0}))]

    def _outcome(self, design: Design) -> Outcome:
        outcome = super()._outcome(design)
        if not float(outcome.tracks["value"][0, 0]) > self.most:
            return outcome
        return attrs.evolve(outcome, tracks={"value": np.full((1, 3), np.nan)}, diverged_at=7)


@attrs.frozen
class Shortsighted(Varied):
    """Overlooks the step at which whole designs diverge; 0: they do not."""

    torn_at: int = 0
    whole: bool = False

    def for_whole_designs(self) -> Shortsighted:
        return attrs.evolve(self, whole=True)

    def _outcome(self, design: Design) -> Outcome:
        outcome = super()._outcome(design)
        if not (self.whole and self.torn_at):
            return outcome
        return attrs.evolve(outcome, tracks={"value": np.full((1, 3), np.nan)}, diverged_at=self.torn_at)


@attrs.frozen
class Suggesting(Varied):
    """Suggests an objective for files with settings, and simulates for longer than it tracks."""

    duration: float = 1.0

    def objective_for(self, designs: Sequence[Design]) -> Mapping[str, Any]:
        return {"name": "toy-late", "until": float(len(designs)) / 4}

    def duration_of(self, design: Design) -> float:
        return self.duration


@attrs.frozen
class Fitting(Varied):
    """Has two options that depend on each other."""

    def __attrs_post_init__(self) -> None:
        if self.gain > self.limit:
            raise ValueError(f"gain = {self.gain} exceeds limit = {self.limit}")


@attrs.frozen
class Unverifiable(Varied):
    """Fails to provide variants, after a delay, if the file *fixed* is missing."""

    delay: float = 0.0
    fixed: str = ""

    def variants(self, design: Design, record: Record) -> Sequence[Variant]:
        logging.getLogger(__name__).info("looking for variants")
        time.sleep(self.delay)
        if self.fixed and Path(self.fixed).exists():
            return super().variants(design, record)
        raise InputError("no variant fits")


@attrs.frozen
class Demanding(Product):
    """Requires a role."""

    requires: ClassVar[tuple[str, ...]] = ("morphology",)


@attrs.frozen
class Value:
    record: ClassVar[Record] = Record(tracks=("value",))

    def score(self, outcome: Outcome) -> float:
        return float(outcome.tracks["value"][0, 0])


@attrs.frozen
class Late(Value):
    """Requires a minimum duration of the simulation."""

    unit: ClassVar[str] = "m"

    until: float = 0.0

    @property
    def record(self) -> Record:  # type: ignore[override]
        return Record(tracks=("value",), until=self.until)


CLOSED: list[Any] = []
"""Executors that were closed."""


@attrs.frozen
class Here:
    workers: ClassVar[int] = 1

    def start(self) -> Here:
        return self

    def map(self, function: Callable[[Any], Any], items: Any) -> list[Any]:
        return [function(item) for item in items]

    def close(self) -> None:
        CLOSED.append(self)


@attrs.frozen
class Many:
    """Claims to have several workers."""

    workers: int = 4

    def start(self) -> Here:
        return Here()


@hookimpl
def evoframe_aggregators() -> Mapping[str, type[Any]]:
    return {"toy-mean": Mean, "toy-share": Share}


@hookimpl
def evoframe_strategies() -> Mapping[str, type[Any]]:
    return {"toy-first": First, "toy-last": Last, "toy-drawn": Drawn}


@hookimpl
def evoframe_encoders() -> Mapping[str, type[Any]]:
    return {"toy-number": Number}


@hookimpl
def evoframe_evolvers() -> Mapping[str, type[Any]]:
    return {"toy-drift": Drift}


@hookimpl
def evoframe_simulators() -> Mapping[str, type[Any]]:
    return {
        "toy-product": Product,
        "toy-slow": Slow,
        "toy-unsound": Unsound,
        "toy-hanging": Hanging,
        "toy-fatal": Fatal,
        "toy-varied": Varied,
        "toy-steered": Steered,
        "toy-shortsighted": Shortsighted,
        "toy-fitting": Fitting,
        "toy-suggesting": Suggesting,
        "toy-demanding": Demanding,
        "toy-unverifiable": Unverifiable,
    }


@hookimpl
def evoframe_objectives() -> Mapping[str, type[Any]]:
    return {"toy-value": Value, "toy-late": Late}


@hookimpl
def evoframe_executors() -> Mapping[str, type[Any]]:
    return {"toy-here": Here, "toy-many": Many}


CONFIGURATION = """
extends = false

[run]
seed = 3
generations = 4

[populations.a]
size = 6
encoder = { name = "toy-number", role = "a" }
evolver = "toy-drift"

[populations.b]
size = 5
encoder = { name = "toy-number", role = "b", needs = ["a"] }
evolver = "toy-drift"

[collaboration]
name = "toy-first"
n = 2

[aggregator]
name = "toy-mean"

[simulator]
name = "toy-product"

[objective]
name = "toy-value"

[executor]
name = "toy-here"
"""
