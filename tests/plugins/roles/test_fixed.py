"""Roles of given designs: of files, of published designs, and of champions of other runs."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import toys

import evoframe
from evoframe import CONTROLLER, MORPHOLOGY, ConfigurationError, Design, InputError, RunConfig
from evoframe.testing import RoleProviderContract
from evoframe_roles import Champion, File, Published
from evoframe_simulators.vox import Vox

SHAPE = (2, 2, 3, 2)  # two bodies


@pytest.fixture
def bodies(tmp_path: Path) -> Path:
    path = tmp_path / "bodies.npz"
    material = np.stack([np.full(SHAPE[1:], 3), np.full(SHAPE[1:], 1)]).astype(np.uint8)
    np.savez(path, material=material, phase_cycles=np.full(SHAPE, 0.25))
    return path


@pytest.fixture
def body(tmp_path: Path) -> Path:
    path = tmp_path / "body.npz"
    np.savez(path, material=np.full(SHAPE[1:], 3, np.uint8), phase_cycles=np.full(SHAPE[1:], 0.25))
    return path


def filled(provider: Any, simulator: Any, design: Design | None = None) -> Design:
    run = provider.start(simulator)
    result: Design = run.fill(design or Design(), np.random.default_rng(0))
    return result


class TestPublished(RoleProviderContract):
    component = Published(design=Vox().published()[2][0])
    simulator = Vox()

    @pytest.mark.parametrize("label", [label for label, _ in Vox().published()])
    def test_gives_each_body_by_its_label(self, label: str) -> None:
        expected = dict(Vox().published())[label].roles[MORPHOLOGY]
        np.testing.assert_array_equal(filled(Published(design=label), Vox()).roles[MORPHOLOGY], expected)

    def test_gives_the_roles_that_are_asked_for(self) -> None:
        label = Vox().published()[0][0]
        design = filled(Published(roles=(MORPHOLOGY, CONTROLLER), design=label), Vox())
        assert set(design.roles) == {MORPHOLOGY, CONTROLLER}

    @pytest.mark.parametrize(
        ("design", "problem"), [("nobody", "no designs 'nobody'"), ("", "several designs, none is chosen")]
    )
    def test_an_unknown_design_is_refused_with_those_there_are(self, design: str, problem: str) -> None:
        with pytest.raises(ConfigurationError) as caught:
            Published(design=design).start(Vox())
        assert problem in caught.value.problem
        assert all(label in caught.value.problem for label, _ in Vox().published())

    def test_a_simulator_without_published_designs_is_refused_by_name(self) -> None:
        with pytest.raises(ConfigurationError, match="Product includes no published designs"):
            Published().start(toys.Product())

    def test_a_role_that_the_design_lacks_is_refused_with_those_it_has(self) -> None:
        provider = Published(roles=("armor",), design=Vox().published()[0][0])
        with pytest.raises(ConfigurationError, match=r"lacks the role 'armor'.*morphology, controller"):
            provider.start(Vox())


class TestFile:
    def test_gives_the_roles_of_its_only_design(self, body: Path) -> None:
        design = filled(File(path=str(body)), Vox(), Design({CONTROLLER: np.zeros(SHAPE[1:])}))
        assert np.unique(design.roles[MORPHOLOGY]).tolist() == [3]
        assert np.unique(design.roles[CONTROLLER]).tolist() == [0.0]

    def test_can_give_the_controller(self, body: Path) -> None:
        design = filled(File(roles=(CONTROLLER,), path=str(body)), Vox(phase_unit="cycles"))
        assert set(design.roles) == {CONTROLLER}
        assert np.unique(design.roles[CONTROLLER]).tolist() == [0.25]

    def test_gives_one_of_several_designs_by_its_label(self, bodies: Path) -> None:
        labels = [label for label, _ in Vox().read(bodies)]
        codes = [
            np.unique(filled(File(path=str(bodies), design=label), Vox()).roles[MORPHOLOGY]).tolist()
            for label in labels
        ]
        assert codes == [[3], [1]]

    def test_with_several_designs_asks_for_a_label(self, bodies: Path) -> None:
        with pytest.raises(ConfigurationError) as caught:
            File(path=str(bodies)).start(Vox())
        assert all(label in caught.value.problem for label, _ in Vox().read(bodies))

    def test_that_is_missing_is_named(self, tmp_path: Path) -> None:
        with pytest.raises(InputError) as caught:
            File(path=str(tmp_path / "none.npz")).start(Vox())
        assert caught.value.source == str(tmp_path / "none.npz")

    def test_is_required(self) -> None:
        with pytest.raises(ConfigurationError, match="set the option path"):
            File().start(Vox())

    def test_needs_a_simulator_that_reads_files(self) -> None:
        with pytest.raises(ConfigurationError, match="Product reads no files"):
            File(path="body.npz").start(toys.Product())

    def test_has_a_state_that_changes_with_its_roles_only(self, body: Path) -> None:
        before = File(path=str(body)).start(Vox()).state()
        np.savez(body, material=np.full(SHAPE[1:], 3, np.uint8), phase_cycles=np.zeros(SHAPE[1:]))
        assert File(path=str(body)).start(Vox()).state() == before
        np.savez(body, material=np.full(SHAPE[1:], 1, np.uint8), phase_cycles=np.zeros(SHAPE[1:]))
        changed = File(path=str(body)).start(Vox())
        assert changed.state() != before
        with pytest.raises(ValueError, match=f"{body}: .*differs"):
            changed.restore(before)

    def test_state_distinguishes_shapes(self, body: Path) -> None:
        before = File(path=str(body)).start(Vox()).state()
        turned = (SHAPE[2], SHAPE[1], SHAPE[3])
        np.savez(body, material=np.full(turned, 3, np.uint8), phase_cycles=np.zeros(turned))
        assert File(path=str(body)).start(Vox()).state() != before


class TestChampion:
    def test_gives_the_roles_of_the_best_pair(
        self, toy_config: Callable[..., RunConfig], tmp_path: Path
    ) -> None:
        finished = evoframe.run(toy_config(), out=tmp_path / "run")
        design = filled(Champion(roles=("a", "b"), run=str(finished.directory)), toys.Product())
        for role, array in finished.champion().design.roles.items():
            np.testing.assert_array_equal(design.roles[role], array)

    def test_a_role_that_it_lacks_is_refused(
        self, toy_config: Callable[..., RunConfig], tmp_path: Path
    ) -> None:
        evoframe.run(toy_config(), out=tmp_path / "run")
        with pytest.raises(ConfigurationError, match="lacks the role 'morphology'; its roles: a, b"):
            Champion(run=str(tmp_path / "run")).start(toys.Product())

    def test_needs_a_run(self, tmp_path: Path) -> None:
        with pytest.raises(ConfigurationError, match="set the option run"):
            Champion().start(toys.Product())
        with pytest.raises(InputError, match="nowhere"):
            Champion(run=str(tmp_path / "nowhere")).start(toys.Product())


@pytest.mark.parametrize("provider", [File(), Published(), Champion()])
def test_given_designs_require_nothing_and_provide_a_body(provider: Any) -> None:
    assert provider.requires == ()
    assert provider.provides == (MORPHOLOGY,)
