"""Compared actions are interleaved."""

from collections.abc import Callable

import attrs

from benchmarks.timing import QUICK, interleaved


class Clock:
    """A clock that only work advances."""

    def __init__(self) -> None:
        self.now = 0.0

    def __call__(self) -> float:
        return self.now

    def work(self, name: str, times: list[float], done: list[str]) -> Callable[[], object]:
        """Return an action that takes each of *times* once, in order, and then the last again and again."""

        def action() -> None:
            self.now += times.pop(0) if len(times) > 1 else times[0]
            done.append(name)

        return action


def test_actions_are_interleaved_after_a_warm_up() -> None:
    clock, done = Clock(), list[str]()
    actions = {name: clock.work(name, [1.0], done) for name in "ab"}
    interleaved(actions, QUICK, clock)
    assert done == ["a", "a", "b", "b", "a", "b", "a", "b", "a", "b"]


def test_the_median_of_the_rounds_counts() -> None:
    clock = Clock()
    taken = interleaved({"a": clock.work("a", [90.0, 90.0, 3.0, 50.0, 2.0], [])}, QUICK, clock)
    assert taken == {"a": 3.0}


def test_short_actions_are_repeated() -> None:
    clock, done = Clock(), list[str]()
    taken = interleaved({"a": clock.work("a", [0.25], done)}, attrs.evolve(QUICK, shortest=1.0), clock)
    assert taken == {"a": 0.25}
    assert len(done) == 2 + 4 * QUICK.rounds
