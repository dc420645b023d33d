"""Robustness from Python."""

from __future__ import annotations

from pathlib import Path

import pytest

from evoframe import ConfigurationError, Plugins, load_run, measure_robustness


class TestFromPython:
    def test_runs_and_paths_are_measured(self, toy_plugins: Plugins, two_runs: list[str]) -> None:
        found = measure_robustness(load_run(Path("run-1")), "run-2", controllers=5, plugins=toy_plugins)
        assert [body.label for body in found.setting.bodies] == two_runs
        assert found.scores.shape == (5, 2)
        assert found.setting.simulation["simulator"]["name"] == "toy-steered"
        louder = measure_robustness(*two_runs, controllers=5, plugins=toy_plugins, simulator={"gain": 2.0})
        assert (louder.scores == 2 * found.scores).all()

    @pytest.mark.parametrize(("controllers", "seed"), [(0, 1), (1, -1)])
    def test_what_cannot_be_drawn_is_refused(
        self, toy_plugins: Plugins, two_runs: list[str], controllers: int, seed: int
    ) -> None:
        with pytest.raises(ConfigurationError, match=r"^expected 1 or more controllers and a seed from 0 up"):
            measure_robustness("run-1", plugins=toy_plugins, controllers=controllers, seed=seed)
