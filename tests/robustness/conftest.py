"""Runs of toys whose champions have a measurable robustness."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from evoframe import RunConfig, run


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def two_runs(here: Path, toy_config: Callable[..., RunConfig]) -> list[str]:
    for seed in (1, 2):
        run(toy_config("simulator=toy-steered", f"run.seed={seed}"), out=f"run-{seed}")
    return ["run-1", "run-2"]
