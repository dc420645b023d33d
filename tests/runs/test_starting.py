"""Start of a run: its configuration, and a directory of its own."""

from __future__ import annotations

import concurrent.futures
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import toys

from evoframe import (
    ConfigurationError,
    InputError,
    RunConfig,
    run,
)
from evoframe.errors import LockedError, NotEmptyError, OccupiedError
from evoframe.files.locks import acquire_lock
from evoframe.registry.registry import Plugins
from evoframe.runs.starting import prepare

Load = Callable[..., RunConfig]


class TestDirectory:
    def test_one_that_is_not_empty_is_refused_and_not_changed(self, toy_config: Load, tmp_path: Path) -> None:
        (tmp_path / "mine.txt").write_text("precious")
        with pytest.raises(NotEmptyError, match="--out") as caught:
            run(toy_config(), out=tmp_path)
        assert not isinstance(caught.value, OccupiedError)
        assert caught.value.source == str(tmp_path)
        assert (tmp_path / "mine.txt").read_text() == "precious"
        assert not (tmp_path / "run.db").exists()

    def test_one_that_is_a_file_is_refused(self, toy_config: Load, toy_file: Path) -> None:
        with pytest.raises(InputError, match="File exists") as caught:
            run(toy_config(), out=toy_file)
        assert caught.value.source == str(toy_file)

    def test_runs_that_start_together_get_numbered_default_directories(
        self, toy_config: Load, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.chdir(tmp_path)
        config = toy_config()
        with concurrent.futures.ThreadPoolExecutor(8) as pool:
            finished = list(pool.map(lambda _: run(config), range(8)))
        names = sorted(str(one.directory) for one in finished)
        assert names == sorted(["runs/toy-3", *(f"runs/toy-3-{number}" for number in range(2, 9))])
        assert all(one.pairs() == finished[0].pairs() for one in finished)

    def test_belongs_to_one_run(self, toy_config: Load, tmp_path: Path) -> None:
        first = prepare(toy_config(), Plugins(), tmp_path / "run")
        with pytest.raises(OccupiedError, match=f"evoframe resume {tmp_path / 'run'}$"):
            prepare(toy_config(), Plugins(), tmp_path / "run")
        with pytest.raises(LockedError):
            acquire_lock(tmp_path / "run")
        assert first.play().finished()


def test_a_directory_is_created_only_after_all_components_have_started(
    toy_config: Load, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuses(*_: Any) -> Any:
        raise ConfigurationError("no")

    monkeypatch.setattr(toys.Drift, "start", refuses)
    with pytest.raises(ConfigurationError, match="no"):
        run(toy_config(), out=tmp_path / "run")
    assert not (tmp_path / "run").exists()


class TestPython:
    def test_settings_are_keyword_arguments(
        self, toy_file: Path, toy_plugins: Plugins, tmp_path: Path
    ) -> None:
        finished = run(
            toy_file,
            seed=5,
            out=tmp_path / "run",
            plugins=toy_plugins,
            collaboration="toy-first",
            **{"run.generations": 1, "collaboration.n": 3},
        )
        assert finished.config["run"] == {"seed": 5, "generations": 1}
        assert finished.config["collaboration"] == {"name": "toy-first", "n": 3}

    def test_the_seed_may_be_a_dotted_key(self, toy_file: Path, toy_plugins: Plugins, tmp_path: Path) -> None:
        finished = run(toy_file, out=tmp_path / "run", plugins=toy_plugins, **{"run.seed": 5})
        assert finished.config["run"]["seed"] == 5

    def test_numpy_numbers_are_accepted(self, toy_file: Path, toy_plugins: Plugins, tmp_path: Path) -> None:
        finished = run(
            toy_file,
            seed=np.int64(5),  # type: ignore[arg-type]  # a common case in scripts
            out=tmp_path / "run",
            plugins=toy_plugins,
            simulator={"limit": np.float64(2.5)},
        )
        assert finished.config["run"]["seed"] == 5
        assert finished.config["simulator"]["limit"] == 2.5

    def test_a_complete_configuration_accepts_no_settings(self, toy_config: Load) -> None:
        with pytest.raises(TypeError, match="load_config"):
            run(toy_config(), seed=4)
