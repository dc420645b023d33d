"""Tests of the number of cores that this process may use."""

from __future__ import annotations

import os

import pytest

from evoframe import available_cores


def test_at_least_one_core_is_available() -> None:
    assert available_cores() >= 1


@pytest.mark.skipif(
    not hasattr(os, "sched_setaffinity"), reason="this platform cannot bind a process to a core"
)
def test_a_process_bound_to_one_core_has_one() -> None:
    before = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {min(before)})
    try:
        assert available_cores() == 1
    finally:
        os.sched_setaffinity(0, before)


def test_newer_versions_of_python_provide_the_count(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "process_cpu_count", lambda: 7, raising=False)
    assert available_cores() == 7
    monkeypatch.setattr(os, "process_cpu_count", lambda: None)
    assert available_cores() == 1


@pytest.mark.parametrize(("count", "cores"), [(5, 5), (None, 1)])
def test_all_cores_count_if_the_affinity_is_unknown(
    monkeypatch: pytest.MonkeyPatch, count: int | None, cores: int
) -> None:
    for name in ("process_cpu_count", "sched_getaffinity"):
        monkeypatch.delattr(os, name, raising=False)
    monkeypatch.setattr(os, "cpu_count", lambda: count)
    assert available_cores() == cores
