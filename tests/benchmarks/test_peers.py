"""Programs that are not installed are listed with the way to install them; the others are measured."""

from __future__ import annotations

import importlib.util
import os
import sys
from pathlib import Path

import attrs
import pytest

from benchmarks.report import Table
from benchmarks.sections.peers import peers
from benchmarks.timing import QUICK

TINY = attrs.evolve(QUICK, rounds=1, designs=1)


def tables() -> dict[str, Table]:
    """Measure the section; return its tables by the first words of their titles."""
    return {table.title.partition(",")[0]: table for table in peers(TINY).tables}


def reasons() -> dict[str, str]:
    """Return why programs are not measured."""
    return {str(row["program"]): str(row["reason"]) for row in tables()["Not measured"].records()}


@pytest.fixture
def nothing_installed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(importlib.util, "find_spec", lambda _: None)
    monkeypatch.delenv("EVOGYM_PYTHON", raising=False)


@pytest.mark.usefixtures("nothing_installed")
def test_missing_programs_are_listed_with_their_installation() -> None:
    found = tables()
    assert list(found) == ["Networks at 432 points", "Not measured"]
    missing = {row["program"]: str(row["reason"]) for row in found["Not measured"].records()}
    assert "pip install --group peers" in missing["MuJoCo"]
    assert "EVOGYM_PYTHON" in missing["EvoGym"]


@pytest.mark.usefixtures("nothing_installed")
def test_an_interpreter_without_evogym_is_the_reason(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    interpreter = tmp_path / "python"
    interpreter.write_text(f'#!/bin/sh\nexec "{sys.executable}" -S "$@"\n')
    interpreter.chmod(0o755)
    monkeypatch.setenv("EVOGYM_PYTHON", str(interpreter))
    assert reasons()["EvoGym"].startswith("EvoGym ended with exit code 1: ModuleNotFoundError")


def test_bars_of_mujoco_have_six_tetrahedra_for_each_voxel() -> None:
    pytest.importorskip("mujoco")
    rows = tables()["A bar of 20 x 8 x 8 voxels"].records()
    assert [row["elements"] for row in rows] == [3456, 7680, 7680, 3456, 7680]
    assert [row["ratio of steps"] == row["ratio of seconds"] == 1.0 for row in rows] == [
        str(row[""]).startswith("evoframe") for row in rows
    ]


@pytest.mark.skipif("EVOGYM_PYTHON" not in os.environ, reason="EVOGYM_PYTHON is not set")
def test_robots_of_evogym_have_as_many_voxels_as_the_cube() -> None:
    evoframe, evogym = tables()["A robot of 216 voxels on a floor"].records()
    assert (evoframe["elements"], evogym["elements"]) == (540, 216)
