# ruff: noqa: S311 - Python's global generator is under test
import json
import random
import threading

import numpy as np
import pytest

from evoframe_evolvers.cppn.randomness import PrivateStream


def stream(seed: int = 0) -> PrivateStream:
    return PrivateStream(np.random.default_rng(seed))


def draw(own: PrivateStream) -> tuple[float, float]:
    with own.swapped_in():
        return random.random(), random.gauss(0.0, 1.0)


def test_the_global_stream_continues_unchanged() -> None:
    random.seed(5)
    expected = [random.random(), random.random()]
    random.seed(5)
    first = random.random()
    draw(stream())
    assert [first, random.random()] == expected


def test_the_global_stream_is_restored_after_an_error() -> None:
    before = random.getstate()

    def fail() -> None:
        with stream().swapped_in():
            random.random()
            raise KeyError

    with pytest.raises(KeyError):
        fail()
    assert random.getstate() == before


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
    with own.swapped_in():
        random.gauss(0.0, 1.0)  # stores a second number for the next call
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
