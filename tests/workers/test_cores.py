"""The number of cores: those that this process may use, not those that there are."""

from __future__ import annotations

import os

import pytest

from evoframe import available_cores


def test_there_is_at_least_one() -> None:
    assert available_cores() >= 1


@pytest.mark.skipif(not hasattr(os, "sched_setaffinity"), reason="a process cannot be kept to a core here")
def test_a_process_that_is_kept_to_one_core_has_one() -> None:
    before = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {min(before)})
    try:
        assert available_cores() == 1
    finally:
        os.sched_setaffinity(0, before)


def test_newer_versions_of_python_are_asked_themselves(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "process_cpu_count", lambda: 7, raising=False)
    assert available_cores() == 7
    monkeypatch.setattr(os, "process_cpu_count", lambda: None)
    assert available_cores() == 1


@pytest.mark.parametrize(("count", "cores"), [(5, 5), (None, 1)])
def test_where_nothing_else_is_known_all_cores_count(
    monkeypatch: pytest.MonkeyPatch, count: int | None, cores: int
) -> None:
    for name in ("process_cpu_count", "sched_getaffinity"):
        monkeypatch.delattr(os, name, raising=False)
    monkeypatch.setattr(os, "cpu_count", lambda: count)
    assert available_cores() == cores
