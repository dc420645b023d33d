"""Robustness from Python."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import toys

from evoframe import ConfigurationError, Plugins, RunConfig, load_run, measure_robustness, run
from evoframe.robustness.api import measurable, measure, setting_of
from evoframe.robustness.candidates import Candidates, read_candidates


class TestFromPython:
    def test_runs_and_paths_are_measured(self, toy_plugins: Plugins, two_runs: list[str]) -> None:
        found = measure_robustness(load_run(Path("run-1")), "run-2", controllers=5, plugins=toy_plugins)
        assert [body.label for body in found.setting.bodies] == two_runs
        assert found.scores.shape == (5, 2)
        assert found.setting.simulation["simulator"]["name"] == "toy-steered"
        louder = measure_robustness(*two_runs, controllers=5, plugins=toy_plugins, simulator={"gain": 2.0})
        assert (louder.scores == 2 * found.scores).all()

    def test_a_preset_replaces_the_settings_of_the_runs(
        self, toy_plugins: Plugins, toy_file: Path, two_runs: list[str]
    ) -> None:
        Path("louder.toml").write_text(
            f'extends = "{toy_file}"\n[simulator]\nname = "toy-steered"\ngain = 2.0'
        )
        found = measure_robustness(*two_runs, controllers=5, plugins=toy_plugins)
        louder = measure_robustness(*two_runs, controllers=5, plugins=toy_plugins, preset="louder.toml")
        assert (louder.scores == 2 * found.scores).all()

    def test_a_file_with_settings_is_scored_by_what_it_is(self) -> None:
        walker = Path(__file__).parents[1] / "data" / "measures" / "walker.vxa"
        measured = measure_robustness(walker, controllers=1)
        assert measured.setting.simulation["objective"]["name"] == "travel"
        assert measured.scores[0, 0] > 0
        chosen = measure_robustness(walker, controllers=1, objective="tip-dz")
        assert chosen.setting.simulation["objective"]["name"] == "tip-dz"

    @pytest.mark.parametrize(("controllers", "seed"), [(0, 1), (1, -1)])
    def test_numbers_out_of_range_are_refused(
        self, toy_plugins: Plugins, two_runs: list[str], controllers: int, seed: int
    ) -> None:
        with pytest.raises(ConfigurationError, match=f"found {controllers} and {seed}"):
            measure_robustness("run-1", plugins=toy_plugins, controllers=controllers, seed=seed)


@pytest.fixture
def candidates(toy_plugins: Plugins, two_runs: list[str]) -> Candidates:
    return read_candidates([Path(name) for name in two_runs], None, [], toy_plugins, published=True)


def test_a_setting_describes_a_measurement_in_advance(candidates: Candidates) -> None:
    setting = setting_of(candidates, 3, 7)
    assert (setting.seed, setting.controllers, setting.unit) == (3, 7, "")
    assert [body.label for body in setting.bodies] == ["run-1", "run-2", "one", "two"]
    assert setting.simulation == candidates.config.simulation()
    assert measure(candidates, setting).setting == setting


def test_a_measurement_is_repeatable_and_shuts_down_its_workers(candidates: Candidates) -> None:
    before = len(toys.CLOSED)
    setting = setting_of(candidates, 3, 7)
    first, second = measure(candidates, setting), measure(candidates, setting)
    assert np.array_equal(first.scores, second.scores, equal_nan=True)
    assert len(toys.CLOSED) == before + 2


class TestMeasurable:
    def test_are_champions_with_their_digests(
        self, toy_plugins: Plugins, two_runs: list[str], candidates: Candidates
    ) -> None:
        found = [each for name in two_runs for each in measurable(Path(name), toy_plugins)]
        bodies = setting_of(candidates, 1, 1).bodies
        assert [each.digest for each in found] == [body.digest for body in bodies[:2]]
        assert found[0].simulation == candidates.config.simulation()

    def test_skips_simulators_that_do_not_draw_controllers(
        self, here: Path, toy_plugins: Plugins, toy_config: Callable[..., RunConfig]
    ) -> None:
        run(toy_config(), out="plain")
        assert [*measurable(Path("plain"), toy_plugins)] == []
