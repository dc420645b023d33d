"""Results of two commits are equal, or their largest difference is reported."""

from __future__ import annotations

import pytest

from benchmarks.against.results import Result, difference

SAME = [Result(0.5, "a", 9), Result(None, "b", 4)]


@pytest.mark.parametrize(
    ("second", "words"),
    [
        (SAME, "equal bit for bit"),
        ([Result(0.5, "other", 9), Result(None, "b", 4)], "equal scores, different tracks"),
        ([Result(0.25, "c", 9), Result(None, "b", 4)], "scores differ by up to 0.25"),
        ([Result(0.5, "a", 9), Result(1.0, "b", 4)], "1 of 2 diverge in one only"),
        (
            [Result(0.75, "a", 9), Result(1.0, "b", 4)],
            "scores differ by up to 0.25, 1 of 2 diverge in one only",
        ),
        ([], "2 and 0 pairs"),
    ],
)
def test_the_difference_is_named(second: list[Result], words: str) -> None:
    assert difference(SAME, second) == words
