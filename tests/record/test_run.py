"""Runs that are read back."""

from __future__ import annotations

import contextlib
import sqlite3
from collections.abc import Callable
from pathlib import Path

import pytest

from evoframe import (
    InputError,
    RunConfig,
    load_run,
    run,
)

Load = Callable[..., RunConfig]


class TestRefusal:
    def test_what_is_no_run_is_refused(self, tmp_path: Path) -> None:
        with pytest.raises(InputError, match="is no run's directory"):
            load_run(tmp_path)
        (tmp_path / "config.toml").write_text("[run]")
        with pytest.raises(InputError, match=r"extends: .* is complete; expected false, found nothing"):
            load_run(tmp_path)
        (tmp_path / "config.toml").write_text("extends = false")
        with pytest.raises(InputError, match=r"run\.db: there is no such file"):
            load_run(tmp_path)
        (tmp_path / "run.db").write_text(
            "this is no database, but it is long enough to be taken for one" * 10
        )
        with pytest.raises(InputError, match="file is not a database"):
            load_run(tmp_path)

    def test_another_format_is_refused(self, toy_config: Load, tmp_path: Path) -> None:
        finished = run(toy_config(), out=tmp_path / "run")
        with contextlib.closing(sqlite3.connect(finished.directory / "run.db")) as database, database:
            database.execute("UPDATE meta SET value = '99' WHERE key = 'format'")
        with pytest.raises(InputError, match="has the format '99', but this evoframe reads format 2"):
            load_run(finished.directory)
