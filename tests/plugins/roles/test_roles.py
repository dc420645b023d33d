"""The names of the built-in providers of roles, and runs with them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import evoframe
from evoframe import CONTROLLER, MORPHOLOGY, ConfigurationError, InputError, Run, load_config
from evoframe.registry.discovery import discover
from evoframe.runs.starting import prepare
from evoframe_roles import Champion, File, Published, RandomController, Uniform, evoframe_roles

CANVAS = (4, 2, 2)
BODIES = """
extends = false

[run]
seed = 5
generations = 2

[populations.morphology]
size = 4
encoder = { name = "cppn-morphology", canvas = [4, 2, 2] }
evolver = "random"

[collaboration]
name = "fittest"
n = 1

[aggregator]
name = "am"

[simulator]
name = "vox"
duration = 0.02

[objective]
name = "tip-yz"
first = 0
last = 1

[executor]
name = "serial"
"""
CONTROLLERS = BODIES.replace("populations.morphology", "populations.controller").replace(
    '{ name = "cppn-morphology", canvas = [4, 2, 2] }', '"cppn-controller"'
)


def test_they_are_registered_by_name() -> None:
    assert evoframe_roles() == {
        "champion": Champion,
        "file": File,
        "published": Published,
        "random": RandomController,
        "uniform": Uniform,
    }


def written(directory: Path, text: str) -> Path:
    path = directory / "given.toml"
    path.write_text(text)
    return path


def finished(directory: Path, text: str, roles: str) -> Run:
    return evoframe.run(written(directory, f"{text}\n{roles}\n"), out=directory / "run")


def body(directory: Path, code: int = 3) -> Path:
    path = directory / "body.npz"
    np.savez(path, material=np.full(CANVAS, code, np.uint8), phase_cycles=np.full(CANVAS, 0.25))
    return path


class TestRuns:
    def test_of_bodies_with_random_controllers(self, tmp_path: Path) -> None:
        run = finished(tmp_path, BODIES, '[roles.phases]\nprovider = "random"\ndraw = "individual"')
        design = run.champion().design
        assert set(design.roles) == {MORPHOLOGY, CONTROLLER}
        assert design.roles[CONTROLLER].shape == CANVAS
        assert len(np.unique(design.roles[CONTROLLER])) == 16

    def test_of_bodies_that_contract_in_phase(self, tmp_path: Path) -> None:
        run = finished(tmp_path, BODIES, '[roles.phases]\nprovider = { name = "uniform", value = 0.5 }')
        assert np.unique(run.champion().design.roles[CONTROLLER]).tolist() == [0.5]

    def test_of_controllers_for_the_body_of_a_file(self, tmp_path: Path) -> None:
        given = f'[roles.body]\nprovider = {{ name = "file", path = "{body(tmp_path)}" }}'
        run = finished(tmp_path, CONTROLLERS, given)
        np.testing.assert_array_equal(run.champion().design.roles[MORPHOLOGY], np.full(CANVAS, 3))

    def test_of_controllers_for_the_champion_of_another_run(self, tmp_path: Path) -> None:
        (tmp_path / "first").mkdir()
        first = finished(tmp_path / "first", BODIES, '[roles.phases]\nprovider = "random"')
        given = f'[roles.body]\nprovider = {{ name = "champion", run = "{first.directory}" }}'
        run = finished(tmp_path, CONTROLLERS, given)
        np.testing.assert_array_equal(
            run.champion().design.roles[MORPHOLOGY], first.champion().design.roles[MORPHOLOGY]
        )

    @pytest.mark.parametrize("draw", ["run", "turn", "individual"])
    def test_are_resumed_bit_for_bit(self, tmp_path: Path, draw: str) -> None:
        roles = f'[roles.phases]\nprovider = "random"\ndraw = "{draw}"'
        whole = finished(tmp_path, BODIES, roles)
        prepare(load_config(tmp_path / "given.toml"), discover(), tmp_path / "stopped").play(lambda: True)
        resumed = evoframe.resume(tmp_path / "stopped")
        assert resumed.pairs() == whole.pairs()
        assert resumed.individuals() == whole.individuals()


class TestResuming:
    def test_with_another_file_is_refused_by_name(self, tmp_path: Path) -> None:
        given = f'[roles.body]\nprovider = {{ name = "file", path = "{body(tmp_path)}" }}'
        config = load_config(written(tmp_path, f"{CONTROLLERS}\n{given}\n"))
        prepare(config, discover(), tmp_path / "run").play(lambda: True)
        body(tmp_path, code=1)
        with pytest.raises(InputError) as caught:
            evoframe.resume(tmp_path / "run")
        for part in ("roles.body.provider", "'file'", str(tmp_path / "body.npz"), "differs"):
            assert part in str(caught.value)
        body(tmp_path)
        assert evoframe.resume(tmp_path / "run").finished()

    def test_without_the_file_is_refused_by_name(self, tmp_path: Path) -> None:
        path = body(tmp_path)
        given = f'[roles.body]\nprovider = {{ name = "file", path = "{path}" }}'
        config = load_config(written(tmp_path, f"{CONTROLLERS}\n{given}\n"))
        prepare(config, discover(), tmp_path / "run").play(lambda: True)
        path.unlink()
        with pytest.raises(InputError) as caught:
            evoframe.resume(tmp_path / "run")
        assert caught.value.source == str(path)


@pytest.mark.parametrize(
    ("roles", "key", "parts"),
    [
        ("[roles.body]\nprovider = 'file'", "roles.body.provider", ["no file is given", "path"]),
        ("[roles.body]\nprovider = 'champion'", "roles.body.provider", ["no run is given", "run"]),
        (
            "[roles.body]\nprovider = { name = 'published', design = 'nobody' }",
            "roles.body.provider",
            ["no designs 'nobody'", "set the option design"],
        ),
        ("[roles.body]\nprovider = 'published'", "roles.body.provider", ["several designs", "design"]),
    ],
)
def test_a_provider_without_its_design_is_refused_before_anything_is_written(
    tmp_path: Path, roles: str, key: str, parts: list[str]
) -> None:
    with pytest.raises(ConfigurationError) as caught:
        finished(tmp_path, CONTROLLERS, roles)
    assert caught.value.key == key
    assert all(part in caught.value.problem for part in parts), caught.value.problem
    assert not (tmp_path / "run").exists()


def test_a_random_controller_needs_a_body(tmp_path: Path) -> None:
    with pytest.raises(ConfigurationError) as caught:
        load_config(written(tmp_path, f"{CONTROLLERS}\n[roles.phases]\nprovider = 'random'\n"))
    keys: Any = {fault.key for fault in caught.value.faults}
    assert "roles.phases.provider" in keys
