"""Tests of random streams."""

from hypothesis import given, strategies as st

from evoframe.evolution.randomness import stream


@given(st.integers(0, 2**64), st.text(), st.text())
def test_streams_depend_only_on_seed_and_name(seed: int, name: str, other: str) -> None:
    first = stream(seed, name).random(3).tolist()
    stream(seed, other).random(5)
    assert stream(seed, name).random(3).tolist() == first
    if name != other:
        assert stream(seed, other).random(3).tolist() != first
    assert stream(seed + 1, name).random(3).tolist() != first
