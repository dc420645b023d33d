"""Faults of a file: one error, in the words of the file."""

from __future__ import annotations

import pytest
from hypothesis import given, strategies as st

from evoframe import InputError
from evoframe_simulators.vox.vxa.faults import Faults

KINDS = ("unsupported", "out_of_range", "missing")


def error(faults: Faults) -> InputError:
    with pytest.raises(InputError) as caught:
        faults.check()
    return caught.value


def test_a_file_without_faults_is_accepted() -> None:
    Faults().check()


@pytest.mark.parametrize("kind", KINDS)
def test_a_single_fault_is_one_line_with_its_tag_as_key(kind: str) -> None:
    faults = Faults()
    getattr(faults, kind)("A/B", "'1'")
    assert (error(faults).key, len(str(error(faults)).splitlines())) == ("A/B", 1)
    assert error(faults).problem.endswith(": '1'")


@given(kinds=st.lists(st.sampled_from(KINDS), min_size=2, max_size=40))
def test_several_faults_are_grouped_with_a_line_each_and_at_most_ten(kinds: list[str]) -> None:
    faults = Faults()
    for n, kind in enumerate(kinds):
        getattr(faults, kind)(f"T{n}", "'1'")
    first, *lines = error(faults).problem.splitlines()
    assert (first, error(faults).key) == (f"{len(kinds)} faults", "")
    shown = [line.split()[0].strip(":") for line in lines if line.startswith("    T")]
    in_groups = [f"T{n}" for kind in dict.fromkeys(kinds) for n, each in enumerate(kinds) if each == kind]
    assert shown == in_groups[:10]
    groups = [line for line in lines if line.endswith(":")]
    assert len(groups) == len(set(groups)) == len({kinds[int(tag[1:])] for tag in shown})
    assert (lines[-1] == f"  ... and {len(kinds) - 10} more") == (len(kinds) > 10)


def test_know_the_sections_that_have_some() -> None:
    faults = Faults()
    assert (bool(faults), faults.within("A")) == (False, False)
    faults.missing("A/B/C", "why")
    assert bool(faults)
    assert [faults.within(place) for place in ("A", "A/B", "A/B/C", "B")] == [True, True, False, False]


def test_a_reason_follows_the_value() -> None:
    faults = Faults()
    faults.unsupported("A", "'1'")
    faults.unsupported("B", "'2'", "why")
    assert error(faults).problem.splitlines()[2:] == ["    A = '1'", "    B = '2' (why)"]
