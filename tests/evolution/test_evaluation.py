"""Tests of the evaluation of designs: scores, their cache, batches and divergence."""

from __future__ import annotations

import threading
from collections.abc import Iterator, Sequence
from typing import Any

import attrs
import numpy as np
import pytest
import toy_capabilities as caps
import toys
from hypothesis import given, strategies as st
from processes import LIMIT

from evoframe import Design, Outcome, Record
from evoframe.errors import ComponentError
from evoframe.evolution.evaluation import Evaluator
from evoframe_executors import Threads


def design(a: float, b: float) -> Design:
    return Design({"a": np.array([a]), "b": np.array([b])})


@attrs.define
class Counting:
    """A simulator that records the designs that it simulates."""

    simulated: list[Design] = attrs.field(factory=list)
    lock: Any = attrs.field(factory=threading.Lock)

    def key(self, given: Design, record: Record) -> bytes:
        return toys.Product().key(given, record)

    def simulate(self, designs: Sequence[Design], record: Record) -> Sequence[Outcome]:
        with self.lock:
            self.simulated += designs
        return toys.Product(limit=100).simulate(designs, record)


@attrs.frozen
class Undefined(toys.Value):
    """An objective that returns NaN."""

    def score(self, outcome: Outcome) -> float:
        del outcome
        return float("nan")


def evaluator(simulator: Any, workers: int = 1) -> Evaluator:
    return Evaluator(simulator, toys.Value(), Threads(workers=workers).start())


pairs = st.lists(st.tuples(st.integers(-3, 3), st.integers(-3, 3)), max_size=30)


@given(pairs, st.sampled_from([1, 2, 5]))
def test_every_design_gets_its_score_and_none_is_simulated_twice(
    numbers: list[tuple[int, int]], workers: int
) -> None:
    counting = Counting()
    scorer = evaluator(counting, workers)
    for _ in range(2):
        scores = scorer.evaluate((design(a, b) for a, b in numbers), len(numbers))
        assert [score.value for score in scores] == [a * b for a, b in numbers]
    assert scorer.simulations == len(counting.simulated) == len(set(numbers))
    scorer.close()


def test_the_key_of_a_repeated_object_is_computed_once() -> None:
    asked = []

    class Noting(Counting):
        def key(self, given: Design, record: Record) -> bytes:
            asked.append(given)
            return super().key(given, record)

    one, equal = design(1, 2), design(1, 2)
    scores = evaluator(Noting()).evaluate([one, equal, one], 3)
    assert [score.value for score in scores] == [2.0, 2.0, 2.0]
    assert asked == [one, equal]  # designs are compared by identity


def test_designs_are_decoded_while_others_are_simulated() -> None:
    started = threading.Event()

    class Signaling(Counting):
        def simulate(self, designs: Sequence[Design], record: Record) -> Sequence[Outcome]:
            started.set()
            return super().simulate(designs, record)

    def made() -> Iterator[Design]:
        yield from (design(a, 1) for a in range(20))
        assert started.wait(LIMIT)
        yield design(20, 1)

    scorer = evaluator(Signaling(), workers=2)
    assert [score.value for score in scorer.evaluate(made(), 21)] == list(range(21))
    scorer.close()


@given(st.integers(0, 40), st.sampled_from([1, 2, 5]))
def test_batches_keep_the_order_and_shrink_towards_the_end(count: int, workers: int) -> None:
    batches = []

    class Noting(Counting):
        def simulate(self, designs: Sequence[Design], record: Record) -> Sequence[Outcome]:
            batches.append([float(given.roles["a"][0]) for given in designs])
            return super().simulate(designs, record)

    @attrs.define
    class OneByOne(toys.Here):
        workers: int = 1  # type: ignore[misc]

    scorer = evaluator(Noting())
    scorer.workers = OneByOne(workers)
    scorer.evaluate((design(a, 1) for a in range(count)), count)
    sizes = [len(batch) for batch in batches]
    assert [a for batch in batches for a in batch] == list(range(count))
    assert sizes == sorted(sizes, reverse=True)
    assert max(sizes, default=1) <= 4
    assert sizes[-1:] in ([], [1])


class TestMeanwhile:
    def test_is_called_once_when_the_workers_have_enough_to_simulate(self) -> None:
        made, seen = [], []

        def designs() -> Iterator[Design]:
            for a in range(100):
                made.append(a)
                yield design(a, 1)

        scorer = evaluator(Counting(), workers=2)
        scores = scorer.evaluate(designs(), 100, lambda: seen.append(len(made)))
        scorer.close()
        assert seen == [3 * 4]  # three batches: two for the other worker, and one more
        assert [score.value for score in scores] == list(range(100))

    @pytest.mark.parametrize("workers", [1, 3])
    def test_is_called_without_anything_to_simulate(self, workers: int) -> None:
        called: list[None] = []
        scorer = evaluator(Counting(), workers)
        scorer.evaluate([design(1, 1)], 1)
        for designs in ([], [design(1, 1)]):
            scorer.evaluate(designs, len(designs), lambda: called.append(None))
        scorer.close()
        assert len(called) == 2

    @pytest.mark.parametrize("error", [ValueError("full"), SystemExit("full"), KeyboardInterrupt()])
    def test_its_exception_is_not_attributed_to_a_component(self, error: BaseException) -> None:
        def fail() -> None:
            raise error

        counting = Counting()
        scorer = evaluator(counting, workers=2)
        with pytest.raises(type(error)) as caught:
            scorer.evaluate((design(a, 1) for a in range(100)), 100, fail)
        assert caught.value is error
        assert len(counting.simulated) <= 3 * 4
        scorer.close()


def test_a_diverged_simulation_has_a_step_and_no_value() -> None:
    [good, bad] = evaluator(Counting()).evaluate([design(1, 2), design(1, 1000)], 2)
    assert (good.value, good.diverged_at) == (2.0, None)
    assert (bad.value, bad.diverged_at) == (None, 1)


def test_a_score_that_is_not_a_number_stops_the_run() -> None:
    with pytest.raises(ComponentError, match="score nan") as caught:
        attrs.evolve(evaluator(Counting()), objective=Undefined()).evaluate([design(1, 1)], 1)
    assert caught.value.component == "objective"


class TestMeasures:
    @staticmethod
    def scored(*measures: str, limit: float = 1e9) -> list[Any]:
        scorer = Evaluator(caps.Measuring(limit), caps.Second(), toys.Here(), measures)
        return scorer.evaluate([design(2, -3), design(1, 1)], 2)

    def test_are_part_of_scores_if_they_are_wanted(self) -> None:
        first, second = self.scored("energy", "smallness")
        assert first.measures == {"energy": 13.0, "smallness": -6.0}
        assert second.measures == {"energy": 2.0, "smallness": -1.0}
        assert self.scored("smallness")[0].measures == {"smallness": -6.0}
        assert self.scored()[0].measures == {}

    def test_are_missing_from_diverged_simulations(self) -> None:
        diverged, good = self.scored("energy", "smallness", limit=2.5)
        assert (diverged.value, diverged.measures) == (None, {})
        assert good.measures == {"energy": 2.0, "smallness": -1.0}

    def test_are_kept_with_the_score(self) -> None:
        scorer = Evaluator(caps.Measuring(), caps.Second(), toys.Here(), ("energy",))
        first, again = (scorer.evaluate([design(2, 3)], 1)[0] for _ in range(2))
        assert scorer.simulations == 1
        assert first.measures == again.measures == {"energy": 13.0}

    def test_of_the_objective_are_asked_for_only_if_one_is_wanted(
        self, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setattr(caps.Second, "measure", lambda *_: pytest.fail("not wanted"))
        assert self.scored()[0].value == -6.0


@given(st.integers(0, 40), st.integers(1, 15), st.sampled_from([1, 3]))
def test_a_simulator_can_limit_the_size_of_batches(count: int, largest: int, workers: int) -> None:
    sizes: list[int] = []

    @attrs.define
    class Limited(Counting):
        batch_size: int = largest
        requires: Any = ()
        tracks: Any = ("value",)

        def check(self, record: Record) -> None:
            pass

        def simulate(self, designs: Sequence[Design], record: Record) -> Sequence[Outcome]:
            with self.lock:
                sizes.append(len(designs))
            return super().simulate(designs, record)

    scorer = evaluator(Limited(), workers)
    scorer.evaluate((design(a, 1) for a in range(count)), count)
    scorer.close()
    assert sum(sizes) == count
    assert max(sizes, default=0) <= largest
    if (count - largest) // workers >= largest:
        assert max(sizes) == largest
