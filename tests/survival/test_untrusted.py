"""Run directories from strangers: no file outside is read or written, and every state is checked."""

from __future__ import annotations

import copy
import json
import os
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner
from hypothesis import given, strategies as st
from opening import is_finished, reopened

from evoframe import EvoframeError, InputError, Run, discover, load_config, load_run, run
from evoframe.cli import cli
from evoframe.errors import ComponentError
from evoframe.evolution.assembly import assemble
from evoframe.record.champion import read_champion


def reopen(directory: Path) -> None:
    reopened(directory, discover())


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Run:
    config = load_config("quick", overrides=["run.generations=1"])
    return run(config, out=tmp_path_factory.mktemp("finished") / "run")


@pytest.fixture
def directory(finished: Run, tmp_path: Path) -> Path:
    return shutil.copytree(finished.directory, tmp_path / "run")


@pytest.mark.parametrize(
    "name", ["run.lock", "run.db", "run.db-wal", "config.toml", "champion.json", ".champion.json.new", "x"]
)
@pytest.mark.parametrize("use", [load_run, is_finished, reopen])
def test_links_are_not_followed(
    directory: Path, tmp_path: Path, name: str, use: Callable[[Path], object]
) -> None:
    outside = tmp_path / "outside"
    outside.write_text("precious")
    (directory / name).unlink(missing_ok=True)
    (directory / name).symlink_to(outside)
    with pytest.raises(InputError, match=f"{name}: .* link"):
        use(directory)
    assert outside.read_text() == "precious"


def test_a_pipe_is_not_read(directory: Path) -> None:
    (directory / "verification.json").unlink()
    os.mkfifo(directory / "verification.json")
    with pytest.raises(InputError, match=r"verification\.json: "):
        load_run(directory)


def test_a_journal_is_not_rolled_back(directory: Path) -> None:
    (directory / "run.db-journal").write_bytes(b"x" * 5000)
    before = (directory / "run.db").read_bytes()
    for use in (load_run, is_finished, reopen):
        with pytest.raises(InputError) as caught:
            use(directory)
        assert caught.value.source == str(directory / "run.db-journal")
    assert (directory / "run.db").read_bytes() == before


def test_an_endless_champion_is_not_read() -> None:
    with pytest.raises(InputError, match=r"/dev/zero: .*64 MiB"):
        read_champion(Path("/dev/zero"))


@pytest.mark.parametrize("command", [["verify"], ["export", "--to", "vxa"], ["resume"], ["doctor"]])
def test_the_configuration_of_a_run_reads_no_other_file(
    directory: Path, tmp_path: Path, command: list[str]
) -> None:
    (tmp_path / "secret.toml").write_text("password = 'precious'")
    path = directory / "config.toml"
    path.write_text(path.read_text().replace("extends = false", "extends = '../secret.toml'"))
    refused = CliRunner().invoke(cli, [*command, str(directory)])
    assert refused.exit_code == 2
    assert f"{path}: extends: " in refused.output
    assert "'../secret.toml'" in refused.output
    assert "precious" not in refused.output


def test_the_simulation_of_a_champion_reads_no_file(directory: Path, tmp_path: Path) -> None:
    (tmp_path / "secret.toml").write_text("password = 'precious'")
    path = directory / "champion.json"
    champion = json.loads(path.read_text())
    champion["simulation"]["extends"] = str(tmp_path / "secret.toml")
    path.write_text(json.dumps(champion))
    refused = CliRunner().invoke(cli, ["simulate", str(path)])
    assert refused.exit_code == 2
    assert "precious" not in refused.output


def places(value: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Yield the paths to all values within JSON values."""
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, inner in items:
        yield (*path, key)
        yield from places(inner, (*path, key))


def changed(state: Any, path: tuple[Any, ...], value: Any) -> Any:
    state = copy.deepcopy(state)
    inner = state
    for key in path[:-1]:
        inner = inner[key]
    inner[path[-1]] = value
    return state


STRANGE = [None, True, -1, 0, 10**30, 1.5, 1e308, float("nan"), "", "x", [], [1], {}, {"x": 1}]


@pytest.mark.parametrize("evolver", ["neat", "random"])
def test_a_state_that_was_tampered_with_is_refused_or_harmless(evolver: str) -> None:
    small = ["run.generations=3", "populations.morphology.size=4", "populations.controller.size=4"]
    evolvers = [f"populations.{role}.evolver={evolver}" for role in ("morphology", "controller")]
    config = load_config("quick", overrides=[*small, *evolvers])
    with assemble(config) as coevolution:
        turns = iter(coevolution)
        next(turns)
        next(turns)
        state = json.loads(json.dumps(coevolution.state()))
    # The 624 words of each random stream are equivalent; skip them.
    everywhere = [path for path in places(state) if len(path) < 6 or path[3] != "random"]

    @given(st.sampled_from(everywhere), st.sampled_from(STRANGE))
    def is_refused_or_harmless(path: tuple[Any, ...], value: Any) -> None:
        with assemble(config) as other:
            try:
                other.restore(changed(state, path, value))
            except (KeyError, TypeError, ValueError, OverflowError):
                return
            except ComponentError as error:  # which names the evolver
                if not isinstance(error.__cause__, KeyError | TypeError | ValueError | OverflowError):
                    raise
                return
            try:
                next(iter(other))
            except (EvoframeError, StopIteration):
                return

    is_refused_or_harmless()
