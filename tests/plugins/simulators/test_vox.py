"""The simulator `vox`: the laws of simulators, the reference data, and what its key leaves out."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import attrs
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from evoframe import ConfigurationError, Design, InputError, Record
from evoframe.testing import SimulatorContract
from evoframe_simulators import Vox
from evoframe_simulators.sampling import sample_steps

DATA = Path(__file__).parents[2] / "data"
PAPER = Record(("tip",), every=0.01, samples=(0, 5))


def golden() -> dict[str, Any]:
    with np.load(DATA / "paper_preset.npz") as arrays:
        return dict(arrays)


def designs() -> list[Design]:
    data = golden()
    return [
        Design({"morphology": body, "controller": phase})
        for body, phase in zip(data["material"], data["phase_cycles"], strict=True)
    ]


def small(seed: int = 0, canvas: tuple[int, int, int] = (4, 3, 3)) -> Design:
    rng = np.random.default_rng(seed)
    material = rng.choice(np.array([0, 1, 3, 3], np.uint8), canvas)
    material[0] = 1
    return Design({"morphology": material, "controller": rng.uniform(-6, 6, canvas)})


class TestVox(SimulatorContract):
    component = Vox(duration=0.05)

    def designs(self) -> list[Design]:
        body = small(1)
        resting = body.roles["controller"] * (body.roles["morphology"] == 3)  # same key as body
        lone = np.zeros((4, 3, 3), np.uint8)
        lone[1, 1, 1] = 3  # no bond, so another time step
        return [
            body,
            Design({**body.roles, "controller": resting}),
            small(2),
            small(3, (6, 2, 2)),
            Design({"morphology": lone, "controller": np.zeros(lone.shape)}),
        ]

    def diverging(self) -> list[Design]:
        empty = np.zeros((4, 3, 3), np.uint8)
        return [Design({"morphology": empty, "controller": np.zeros(empty.shape)})]


class TestUnstableVox(TestVox):
    """With a damping that no time step can follow."""

    component = Vox(duration=0.05, bond_damping=1e4)

    def designs(self) -> list[Design]:
        return [
            Design({"morphology": np.full((n, 1, 1), 1, np.uint8), "controller": np.zeros((n, 1, 1))})
            for n in (1, 2, 3)
        ]

    def diverging(self) -> list[Design]:
        return [small(1), small(2)]


class TestPaper:
    def test_displacements_are_those_of_the_authors_engine(self, capsys: pytest.CaptureFixture[str]) -> None:
        outcomes = Vox().simulate(designs(), PAPER)
        displacement = [outcome.tracks["tip"][1, 2] - outcome.tracks["tip"][0, 2] for outcome in outcomes]
        worst = np.abs(np.array(displacement) - golden()["displacement"]).max()
        with capsys.disabled():
            print(f"\nvox against the authors' engine, 36 bodies: displacement within {worst:.1e} m", end=" ")  # noqa: T201
        assert worst < 1e-9

    def test_without_contraction_the_published_bodies_move_all_the_same(self) -> None:
        still = Vox(expansion_coefficient=0.0)
        outcomes = still.simulate([designs()[i] for i in (0, 3, 6)], PAPER)
        displacement = [outcome.tracks["tip"][1, 2] - outcome.tracks["tip"][0, 2] for outcome in outcomes]
        assert displacement == pytest.approx([0.0011106, 0.0019527, 0.0020189], abs=5e-8)

    def test_samples_fall_after_the_steps_of_the_engine(self) -> None:
        [outcome] = Vox().simulate(designs()[:1], Record(("tip",), every=0.01))
        assert outcome.steps.tolist() == [1, 5, 9, 13, 17, 21]
        assert outcome.times[[0, 5]] == pytest.approx([0.0032029, 0.0672616], abs=5e-8)


class TestKey:
    def key(self, vox: Vox, body: Design, **changed: Any) -> bytes:
        return vox.key(Design({**body.roles, **changed}), PAPER)

    def test_a_phase_counts_only_where_the_voxel_contracts(self) -> None:
        body = small()
        material, phase = body.roles["morphology"], body.roles["controller"]
        idle = np.where(material == 3, phase, 0.5)
        acting = np.where(material == 3, 0.5, phase)
        assert self.key(Vox(), body, controller=idle) == self.key(Vox(), body)
        assert self.key(Vox(), body, controller=acting) != self.key(Vox(), body)

    def test_a_phase_counts_in_single_precision_as_the_solver_reads_it(self) -> None:
        body = small()
        phase = body.roles["controller"]
        assert self.key(Vox(), body, controller=phase * (1 + 1e-12)) == self.key(Vox(), body)
        assert self.key(Vox(), body, controller=phase * (1 + 1e-6)) != self.key(Vox(), body)
        zero = np.zeros(phase.shape)
        assert self.key(Vox(), body, controller=zero) == self.key(Vox(), body, controller=-zero)

    def test_without_expansion_no_phase_counts(self) -> None:
        still = Vox(expansion_coefficient=0.0)
        assert self.key(still, small(), controller=np.zeros((4, 3, 3))) == self.key(still, small())

    def test_the_shape_counts(self) -> None:
        body = small()
        turned = {role: array.reshape(3, 4, 3) for role, array in body.roles.items()}
        assert self.key(Vox(), Design(turned)) != self.key(Vox(), body)


def test_radians_are_cycles_times_two_pi() -> None:
    body = small()
    radians = Design({**body.roles, "controller": body.roles["controller"] * math.tau})
    [in_cycles] = Vox().simulate([body], PAPER)
    [in_radians] = Vox(phase_unit="radians").simulate([radians], PAPER)
    assert in_radians.tracks["tip"] == pytest.approx(in_cycles.tracks["tip"], abs=1e-12)
    assert Vox(phase_unit="radians").key(radians, PAPER) == Vox().key(body, PAPER)


def test_an_empty_body_counts_as_diverged_before_the_first_step() -> None:
    [empty] = TestVox().diverging()
    [outcome] = Vox().simulate([empty], PAPER)
    assert outcome.diverged_at == 0


@pytest.mark.parametrize(
    ("roles", "message"),
    [
        (
            {"morphology": np.ones((2, 2), np.uint8)},
            r"morphology is uint8\[2, 2\]; expected uint8\[X, Y, Z\]",
        ),
        ({"morphology": np.ones((4, 3, 3))}, "morphology is float64"),
        (
            {"controller": np.zeros((3, 3, 3))},
            r"controller is float64\[3, 3, 3\]; expected float64\[4, 3, 3\]",
        ),
        ({"morphology": np.full((4, 3, 3), 7, np.uint8)}, "material code"),
        ({"controller": np.full((4, 3, 3), np.nan)}, "phase"),
    ],
)
def test_what_is_no_design_is_refused(roles: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        Vox().simulate([Design({**small(5).roles, **roles})], PAPER)


class TestSampling:
    @given(
        time_step=st.floats(1e-5, 1e-2),
        steps=st.integers(1, 200),
        every=st.floats(0, 0.1),
        initial=st.booleans(),
    )
    def test_samples_are_ascending_and_at_least_so_far_apart(
        self, time_step: float, steps: int, every: float, initial: bool
    ) -> None:
        taken = sample_steps(time_step, steps, Record((), every=every, initial=initial))
        assert taken[0] == (0 if initial else 1)
        taken = taken[1:] if initial else taken
        assert taken[0] == 1
        assert (np.diff(taken) >= 1).all()
        assert (np.diff(taken) * time_step >= every * (1 - 1e-12) - 1e-12).all()
        assert taken[-1] <= steps

    def test_without_an_interval_every_step_is_sampled(self) -> None:
        assert sample_steps(0.1, 5, Record(())).tolist() == [1, 2, 3, 4, 5]

    def test_samples_are_chosen_by_index(self) -> None:
        assert sample_steps(0.1, 9, Record((), every=0.25, samples=(0, 2), initial=True)).tolist() == [
            0,
            1,
            7,
        ]


def test_a_sample_after_the_end_is_refused_with_the_numbers() -> None:
    with pytest.raises(ConfigurationError) as caught:
        Vox(duration=0.03).check(PAPER)
    assert str(caught.value) == (
        "sample 5 of one every 0.01 s is never taken: "
        "vox makes 10 steps in simulator.duration = 0.03 s, samples 0 to 2"
    )


def test_settings_with_one_canvas_share_a_model() -> None:
    from evoframe_simulators.vox import _model  # noqa: PLC0415

    assert _model(Vox(), (4, 3, 3)) is _model(attrs.evolve(Vox()), (4, 3, 3))
    assert _model(Vox(), (4, 3, 3)) is not _model(Vox(duration=1.0), (4, 3, 3))
