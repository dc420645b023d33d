"""Tests of populations that start with the genomes of another run."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
import toy_capabilities

from evoframe import (
    ConfigurationError,
    Plugins,
    Run,
    RunConfig,
    RunError,
    assemble,
    load_run,
    resume,
    run,
)
from evoframe.runs.execution import Execution
from evoframe.runs.starting import prepare

Load = Callable[..., RunConfig]

WANTING = "populations.a.evolver={name='toy-wanting', wants=[]}"


@pytest.fixture
def other(toy_config: Load, tmp_path: Path, toy_plugins: Plugins) -> Run:
    return run(toy_config(WANTING), out=tmp_path / "other", plugins=toy_plugins)


def initial(config: RunConfig, plugins: Plugins, out: Path) -> list[float]:
    """Return the genomes of population a in the initial turn of a run."""
    execution = prepare(config, plugins, out)
    execution.play(lambda: True)
    return list(execution._coevolution.populations[0].genomes)


def abandon(execution: Execution) -> None:
    """Leave a run as a kill before its first turn does."""
    execution._coevolution.close()
    execution._store.close()


def last_genomes(config: RunConfig) -> list[float]:
    """Return the genomes at the end of a run, the fittest first."""
    with assemble(config) as coevolution:
        for _ in coevolution:
            pass
        population = coevolution.populations[0]
        ranked = sorted(range(len(population.genomes)), key=lambda i: -(population.members[i].fitness or 0.0))
        return [population.genomes[i] for i in ranked]


def test_it_starts_with_the_last_members_the_fittest_first(
    toy_config: Load, toy_plugins: Plugins, other: Run, tmp_path: Path
) -> None:
    config = toy_config(WANTING, f"populations.a.start.run='{other.directory}'", "run.seed=5")
    assert initial(config, toy_plugins, tmp_path / "run") == last_genomes(toy_config(WANTING))


def test_it_starts_with_as_many_as_it_has_members(
    toy_config: Load, toy_plugins: Plugins, other: Run, tmp_path: Path
) -> None:
    config = toy_config(WANTING, f"populations.a.start.run='{other.directory}'", "populations.a.size=3")
    assert initial(config, toy_plugins, tmp_path / "run") == last_genomes(toy_config(WANTING))[:3]


def test_it_starts_with_the_champion(
    toy_config: Load, toy_plugins: Plugins, other: Run, tmp_path: Path
) -> None:
    start = f"populations.a.start={{run='{other.directory}', take='champion'}}"
    found = initial(toy_config(WANTING, start), toy_plugins, tmp_path / "run")
    assert found[0] == other.champion().genomes["a"]


def test_a_run_is_resumed_without_the_other_one(
    toy_config: Load, toy_plugins: Plugins, other: Run, tmp_path: Path
) -> None:
    config = toy_config(WANTING, f"populations.a.start.run='{other.directory}'", "run.seed=5")
    whole = run(config, out=tmp_path / "whole", plugins=toy_plugins)
    prepare(config, toy_plugins, tmp_path / "left").play(lambda: True)
    other.directory.rename(tmp_path / "elsewhere")
    resumed = resume(tmp_path / "left", plugins=toy_plugins)
    assert resumed.pairs() == whole.pairs()
    assert load_run(tmp_path / "left").finished()


def test_a_run_that_was_killed_before_its_first_turn_reads_them_again(
    toy_config: Load, toy_plugins: Plugins, other: Run, tmp_path: Path
) -> None:
    config = toy_config(WANTING, f"populations.a.start.run='{other.directory}'", "run.seed=5")
    whole = run(config, out=tmp_path / "whole", plugins=toy_plugins)
    abandon(prepare(config, toy_plugins, tmp_path / "left"))
    assert resume(tmp_path / "left", plugins=toy_plugins).pairs() == whole.pairs()


def test_other_populations_can_start_with_the_best_of_several_draws(
    toy_config: Load, toy_plugins: Plugins, other: Run, tmp_path: Path
) -> None:
    loading = "populations.b.evolver={name='toy-wanting', wants=[]}"
    start = f"populations.a.start.run='{other.directory}'"
    config = toy_config(WANTING, loading, start, "populations.b.start.draws=3")
    assert initial(config, toy_plugins, tmp_path / "run") == last_genomes(toy_config(WANTING))


def test_a_run_without_a_turn_is_refused(toy_config: Load, toy_plugins: Plugins, tmp_path: Path) -> None:
    abandon(prepare(toy_config(WANTING), toy_plugins, tmp_path / "new"))
    config = toy_config(WANTING, f"populations.a.start.run='{tmp_path / 'new'}'")
    with pytest.raises(ConfigurationError, match="no individuals yet") as caught:
        prepare(config, toy_plugins, tmp_path / "run")
    assert caught.value.key == "populations.a.start"


def test_a_population_that_the_other_run_lacks_is_named(
    toy_config: Load, toy_plugins: Plugins, other: Run, tmp_path: Path
) -> None:
    start = f"populations.a.start={{run='{other.directory}', population='c'}}"
    with pytest.raises(ConfigurationError, match="no population 'c'; its populations: a, b") as caught:
        prepare(toy_config(WANTING, start), toy_plugins, tmp_path / "run")
    assert caught.value.key == "populations.a.start"
    assert not (tmp_path / "run").exists()


def test_a_run_that_does_not_exist_is_named(toy_config: Load, toy_plugins: Plugins, tmp_path: Path) -> None:
    with pytest.raises(ConfigurationError, match="nowhere") as caught:
        prepare(toy_config(WANTING, "populations.a.start.run=nowhere"), toy_plugins, tmp_path / "run")
    assert caught.value.key == "populations.a.start.run"


def test_an_evolver_that_accepts_no_genomes_is_named(
    toy_config: Load, toy_plugins: Plugins, other: Run, tmp_path: Path
) -> None:
    config = toy_config(f"populations.b.start.run='{other.directory}'")
    with pytest.raises(ConfigurationError, match="cannot start with given genomes") as caught:
        prepare(config, toy_plugins, tmp_path / "run")
    assert caught.value.key == "populations.b.evolver"


def test_genomes_of_another_kind_are_refused(
    toy_config: Load, toy_plugins: Plugins, other: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def failing(self: object, dumped: object) -> float:
        raise ValueError(f"no genome: {dumped}")

    monkeypatch.setattr(toy_capabilities.WantingRun, "load", failing)
    config = toy_config(WANTING, f"populations.a.start.run='{other.directory}'")
    with pytest.raises(ConfigurationError, match="no genome") as caught:
        prepare(config, toy_plugins, tmp_path / "run")
    assert caught.value.key == "populations.a.start"


def test_a_loop_without_the_genomes_does_not_start(toy_config: Load) -> None:
    coevolution = assemble(toy_config(WANTING, "populations.a.start.run=there"))
    with coevolution, pytest.raises(RunError, match="starts with genomes of the run there"):
        next(iter(coevolution))
