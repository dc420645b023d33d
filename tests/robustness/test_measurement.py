"""All bodies are measured with the same random controllers; diverged simulations have no score."""

from __future__ import annotations

import random
from typing import Any

import attrs
import numpy as np
import pytest
import toys
from hypothesis import given, strategies as st
from measuring import body, measure, setting

from evoframe import Design, Divergence, InputError, WorkerError
from evoframe.contract.optional import SupportsPublished, SupportsRandomControllers
from evoframe.errors import ComponentError
from evoframe.robustness.measurement import Bench, digest_of, draw_controller
from evoframe_executors import Processes, Threads

numbers = st.lists(st.floats(0.5, 4.0), min_size=1, max_size=5, unique=True)


@given(numbers, st.integers(1, 30))
def test_controllers_are_the_same_for_all_bodies(given_numbers: list[float], controllers: int) -> None:
    scores = measure(given_numbers, controllers).scores
    assert scores.shape == (controllers, len(given_numbers))
    drawn = scores / np.array(given_numbers)
    assert np.allclose(drawn, drawn[:, :1], rtol=1e-12, atol=0)
    assert len(np.unique(scores[:, 0])) == controllers  # all controllers differ


@given(numbers, st.randoms(use_true_random=False))
def test_scores_do_not_depend_on_the_order_of_bodies(
    given_numbers: list[float], chance: random.Random
) -> None:
    order = chance.sample(range(len(given_numbers)), len(given_numbers))
    shuffled = measure([given_numbers[place] for place in order], most=1.0)
    assert np.array_equal(shuffled.scores, measure(given_numbers, most=1.0).scores[:, order], equal_nan=True)


@given(st.integers(1, 40), st.integers(1, 40), st.integers(0, 2**40))
def test_more_controllers_include_those_of_fewer(few: int, more: int, seed: int) -> None:
    fewest = min(few, more)
    first, second = (measure([1.0, 2.0], count, seed=seed).scores for count in (few, more))
    assert np.array_equal(first[:fewest], second[:fewest])


def test_another_seed_draws_other_controllers() -> None:
    assert not np.isin(measure([1.0], seed=1).scores, measure([1.0], seed=2).scores).any()


@pytest.mark.parametrize("executor", [Threads(workers=1), Threads(workers=3), Processes(workers=2)])
def test_scores_do_not_depend_on_the_workers(executor: Any) -> None:
    workers = executor.start()
    here, there = (measure([1.0, 2.0, 3.0], 100, most=0.5, workers=who) for who in (None, workers))
    workers.close()
    assert np.array_equal(here.scores, there.scores, equal_nan=True)
    assert here.diverged == there.diverged != ()


def test_progress_counts_every_simulation() -> None:
    done: list[int] = []
    designs = [body(1.0), body(2.0)]
    bench = Bench(toys.Steered(), toys.Value(), toys.Here())
    bench.measure(setting(designs, 101), designs, done.append)
    assert sum(done) == 202
    assert len(done) > 2


class TestDivergence:
    @given(st.floats(0.1, 3.9))
    def test_is_recorded_and_has_no_score(self, most: float) -> None:
        whole, found = measure([1.0, 4.0], 30), measure([1.0, 4.0], 30, most=most)
        lost = whole.scores > most
        assert np.array_equal(np.isnan(found.scores), lost)
        assert np.array_equal(found.scores[~lost], whole.scores[~lost])
        assert found.diverged == tuple(
            Divergence(int(row), int(column), 7) for row, column in np.argwhere(lost)
        )
        assert found.common.tolist() == np.flatnonzero(~lost.any(axis=1)).tolist()
        for column in (0, 1):
            assert found.lost([column]) == lost[:, column].sum()
            assert sorted(found.values([column])) == sorted(whole.scores[~lost[:, column], column])

    def test_of_all_simulations_leaves_no_scores(self) -> None:
        found = measure([1.0, 2.0], 5, most=-100.0)
        assert found.lost([0, 1]) == len(found.diverged) == 10
        assert not len(found.common)
        assert not len(found.values([0, 1]))


class TestDigest:
    def test_depends_on_the_body_but_not_on_its_controller(self) -> None:
        simulator = toys.Steered()
        other = body(2.0).with_role("b", np.array([0.25]))
        assert digest_of(simulator, body(2.0)) == digest_of(simulator, other)
        assert digest_of(simulator, body(2.0)) != digest_of(simulator, body(3.0))


class TestSimulator:
    def test_supports_only_the_protocols_that_it_implements(self) -> None:
        assert isinstance(toys.Steered(), SupportsRandomControllers)
        assert isinstance(toys.Steered(), SupportsPublished)
        assert not isinstance(toys.Varied(), SupportsRandomControllers)
        assert not isinstance(toys.Varied(), SupportsPublished)

    def test_that_does_not_draw_a_design_is_named(self) -> None:
        class Careless(toys.Steered):
            def random_controller(self, design: Design, rng: np.random.Generator) -> Any:
                return design.roles

        with pytest.raises(ComponentError, match=type(body(1.0).roles).__name__) as caught:
            draw_controller(Careless(), body(1.0), 1, 0)
        assert caught.value.component == "simulator"

    def test_that_fails_is_named_with_body_and_controllers(self) -> None:
        @attrs.frozen
        class Failing(toys.Steered):
            def simulate(self, designs: Any, record: Any) -> Any:
                raise ZeroDivisionError("no")

        designs = [body(1.0)]
        with pytest.raises(ComponentError) as caught:
            Bench(Failing(), toys.Value(), toys.Here()).measure(setting(designs, 3), designs)
        assert caught.value.component == "simulator"
        assert "ZeroDivisionError: no" in caught.value.problem
        assert caught.value.concerns == "A, controllers 0 to 2"

    def test_that_refuses_a_body_is_quoted_with_the_name_of_the_body(self) -> None:
        @attrs.frozen
        class Refusing(toys.Steered):
            def simulate(self, designs: Any, record: Any) -> Any:
                raise InputError("has no voxel")

        designs = [body(1.0)]
        with pytest.raises(InputError) as caught:
            Bench(Refusing(), toys.Value(), toys.Here()).measure(setting(designs, 3), designs)
        assert (caught.value.source, caught.value.problem) == ("A", "has no voxel")

    def test_whose_worker_is_lost_is_named_with_body_and_controllers(self) -> None:
        class Losing(toys.Here):
            def map(self, function: Any, items: Any) -> Any:
                raise WorkerError("took too long", items[0])

        designs = [body(1.0)]
        with pytest.raises(ComponentError) as caught:
            Bench(toys.Steered(), toys.Value(), Losing()).measure(setting(designs, 3), designs)
        assert caught.value.component == "simulator"
        assert caught.value.problem == "took too long"
        assert caught.value.concerns == "A, controllers 0 to 2"


@pytest.mark.parametrize(("controllers", "seed"), [(0, 1), (1, -1)])
def test_a_setting_out_of_range_is_refused(controllers: int, seed: int) -> None:
    with pytest.raises(ValueError, match=">="):
        setting([body(1.0)], controllers, seed)
