# ruff: noqa: S311 - Python's global generator is under test
import json
import random
import threading

import neat.attributes
import neat.genes
import neat.genome
import neat.reproduction
import numpy as np
import pytest

from evoframe_evolvers.cppn.randomness import PrivateStream


def stream(seed: int = 0) -> PrivateStream:
    return PrivateStream(np.random.default_rng(seed))


def draw(own: PrivateStream) -> tuple[float, float]:
    with own.swapped_in():
        return neat.genes.random(), neat.attributes.gauss(0.0, 1.0)


def drawn_by_neat() -> list[float]:
    return [
        neat.attributes.choice([1.0, 2.0]),
        neat.attributes.gauss(0.0, 1.0),
        neat.attributes.random(),
        neat.attributes.uniform(0.0, 1.0),
        neat.attributes.randint(1, 9),
        neat.genes.random(),
        neat.genome.choice([1.0, 2.0]),
        neat.genome.random(),
        neat.reproduction.random.random(),
    ]


def test_neat_draws_what_the_functions_of_python_would_draw() -> None:
    with stream().swapped_in() as own:
        random.setstate(own.getstate())
        private = drawn_by_neat()
    assert private == drawn_by_neat()


def test_the_global_stream_does_not_change() -> None:
    before = random.getstate()
    with stream().swapped_in():
        drawn_by_neat()
    assert random.getstate() == before


def test_a_simulation_in_another_thread_can_draw_and_seed() -> None:
    expected = draw(stream())
    own = stream()
    with own.swapped_in():
        random.seed(0)
        first = neat.genes.random()
        random.random()
        assert (first, neat.attributes.gauss(0.0, 1.0)) == expected


def test_neat_draws_from_the_global_stream_again_after_an_error() -> None:
    def fail() -> None:
        with stream().swapped_in():
            raise KeyError

    with pytest.raises(KeyError):
        fail()
    assert neat.reproduction.random is random
    assert (neat.genes.random, neat.attributes.gauss) == (random.random, random.gauss)


def test_each_stream_continues_where_it_stopped() -> None:
    alone, one, other = stream(1), stream(1), stream(2)
    expected = [draw(alone) for _ in range(3)]
    interleaved = []
    for _ in range(3):
        interleaved.append(draw(one))
        draw(other)
    assert interleaved == expected
    assert len(set(expected)) == 3


def test_streams_of_several_threads_do_not_mix() -> None:
    expected = {seed: [draw(own) for own in [stream(seed)] for _ in range(300)] for seed in range(4)}
    found: dict[int, list[tuple[float, float]]] = {}

    def work(seed: int) -> None:
        own = stream(seed)
        found[seed] = [draw(own) for _ in range(300)]

    threads = [threading.Thread(target=work, args=(seed,)) for seed in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == expected


def test_a_restored_stream_continues_bit_for_bit() -> None:
    own, other = stream(1), stream(2)
    with own.swapped_in() as twister:
        twister.gauss(0.0, 1.0)  # stores a second number for the next call
    state = own.state()
    assert json.loads(json.dumps(state)) == state
    other.restore(json.loads(json.dumps(state)))
    assert [draw(other) for _ in range(3)] == [draw(own) for _ in range(3)]


@pytest.mark.parametrize(
    "state", [None, [], [3, [1, 2], None], [9, [], None], [3, [-1] * 625, None], [3, "x", None]]
)
def test_an_invalid_state_is_refused(state: object) -> None:
    own, untouched = stream(), stream()
    with pytest.raises(ValueError, match=r"state\.pool\.random: "):
        own.restore(state)
    assert draw(own) == draw(untouched)
