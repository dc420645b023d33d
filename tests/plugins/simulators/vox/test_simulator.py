"""The simulator `vox`: contract of simulators, reference data, and keys of designs."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from bars import bar, soft, torn
from hypothesis import given, strategies as st
from hypothesis.extra import numpy as hnp

from evoframe import ConfigurationError, Design, InputError, Record
from evoframe.testing import SimulatorContract
from evoframe_simulators import FixedRegion, Vox

DATA = Path(__file__).parents[3] / "data"
PAPER = Record(("tip",), every=0.01, samples=(0, 5))
EARLY = Record(("tip",), every=0.01, samples=(0, 3))


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


class TestTornVox(TestVox):
    """A body that diverges only if it is simulated as a whole, or recorded near the divergence."""

    component = Vox(duration=0.05, largest_strain=0.14)

    def designs(self) -> list[Design]:
        return [bar(1, 3, 3, 1), bar(1, 3, 3), bar(3)]

    def diverging(self) -> list[Design]:
        return [*super().diverging(), torn()]

    def test_the_tip_alone_does_not_diverge(self) -> None:
        """The examples contain what the laws are about."""
        [alone], [whole] = (
            vox.simulate([torn()], EARLY) for vox in (self.component, self.component.for_whole_designs())
        )
        assert (alone.diverged_at, whole.diverged_at) == (None, 2)


class TestWalkingVox(TestVox):
    """Options for a free body: environment, physical contacts and substeps."""

    component = Vox(
        duration=0.05,
        substeps=2,
        start_time=0.01,
        ramp=0.02,
        gravity=-9.81,
        floor=True,
        floor_slope=3.0,
        fluid_drag=10.0,
        fixed=(FixedRegion(size=(0.1, 1.0, 1.0), degrees_of_freedom=("y",)),),
        collision_envelope=1.2,
        contact_damping=0.5,
        contact_friction=True,
        complete_contacts=True,
    )

    def record(self) -> Record:
        return Record(("tip", "face", "body", "energy", "strain", "momentum"), every=0.003)


class TestUnstableVox(TestVox):
    """Options with damping that is too strong for the time step."""

    component = Vox(duration=0.05, bond_damping=1e4)

    def designs(self) -> list[Design]:
        return [
            Design({"morphology": np.full((n, 1, 1), 1, np.uint8), "controller": np.zeros((n, 1, 1))})
            for n in (1, 2, 3)
        ]

    def diverging(self) -> list[Design]:
        return [small(1), small(2)]


class TestPaper:
    def test_displacements_agree_with_the_authors_engine(self, capsys: pytest.CaptureFixture[str]) -> None:
        outcomes = Vox().simulate(designs(), PAPER)
        displacement = [outcome.tracks["tip"][1, 2] - outcome.tracks["tip"][0, 2] for outcome in outcomes]
        worst = np.abs(np.array(displacement) - golden()["displacement"]).max()
        with capsys.disabled():
            print(f"\nvox against the authors' engine, 36 bodies: displacement within {worst:.1e} m", end=" ")  # noqa: T201
        assert worst < 1e-9

    def test_without_contraction_the_published_bodies_move_as_in_the_engine(self) -> None:
        still = Vox(expansion_coefficient=0.0)
        outcomes = still.simulate([designs()[i] for i in (0, 3, 6)], PAPER)
        displacement = [outcome.tracks["tip"][1, 2] - outcome.tracks["tip"][0, 2] for outcome in outcomes]
        assert displacement == pytest.approx([0.0011106, 0.0019527, 0.0020189], abs=5e-8)

    def test_samples_fall_after_the_steps_of_the_engine(self) -> None:
        [outcome] = Vox().simulate(designs()[:1], Record(("tip",), every=0.01))
        assert outcome.steps.tolist() == [1, 5, 9, 13, 17, 21]
        assert outcome.times[[0, 5]] == pytest.approx([0.0032029, 0.0672616], abs=5e-8)


# Few values, so that bodies and phases are often equal; 1 + 1e-9 is 1 in single precision.
BODIES = hnp.arrays(np.uint8, (1, 1, 2), elements=st.sampled_from([0, 1, 3]))
PHASES = hnp.arrays(np.float64, (1, 1, 2), elements=st.sampled_from([0.0, -0.0, 1.0, 1.0 + 1e-9, 2.0]))


class TestKey:
    def key(self, vox: Vox, body: Design, **changed: Any) -> bytes:
        return vox.key(Design({**body.roles, **changed}), PAPER)

    def test_the_key_depends_on_phases_of_contractile_voxels_only(self) -> None:
        body = small()
        material, phase = body.roles["morphology"], body.roles["controller"]
        idle = np.where(material == 3, phase, 0.5)
        acting = np.where(material == 3, 0.5, phase)
        assert self.key(Vox(), body, controller=idle) == self.key(Vox(), body)
        assert self.key(Vox(), body, controller=acting) != self.key(Vox(), body)

    def test_the_key_depends_on_phases_in_single_precision_like_the_solver(self) -> None:
        body = small()
        phase = body.roles["controller"]
        assert self.key(Vox(), body, controller=phase * (1 + 1e-12)) == self.key(Vox(), body)
        assert self.key(Vox(), body, controller=phase * (1 + 1e-6)) != self.key(Vox(), body)
        zero = np.zeros(phase.shape)
        assert self.key(Vox(), body, controller=zero) == self.key(Vox(), body, controller=-zero)

    def test_without_expansion_the_key_does_not_depend_on_phases(self) -> None:
        still = Vox(expansion_coefficient=0.0)
        assert self.key(still, small(), controller=np.zeros((4, 3, 3))) == self.key(still, small())

    def test_the_key_depends_on_phases_of_expanding_and_contracting_materials(self) -> None:
        vox = Vox(palette=(soft(1), soft(2, expansion_coefficient=-0.01), soft(3)))
        body = bar(1, 2, 3)
        keys = [
            vox.key(body.with_role("controller", np.eye(3)[n].reshape(3, 1, 1)), Record(("tip",)))
            for n in range(3)
        ]
        assert keys[0] == keys[2] == vox.key(body, Record(("tip",)))
        assert keys[1] != keys[0]

    def test_without_an_amplitude_the_key_does_not_depend_on_phases(self) -> None:
        vox = Vox(temperature_amplitude=25.0)
        turned = bar(3, 3).with_role("controller", np.ones((2, 1, 1)))
        assert vox.key(turned, Record(("tip",))) == vox.key(bar(3, 3), Record(("tip",)))

    @given(BODIES, BODIES, PHASES, PHASES)
    def test_keys_are_equal_if_and_only_if_body_and_acting_phases_are(
        self, body: Any, other: Any, phase: Any, turned: Any
    ) -> None:
        designs = [Design({"morphology": body, "controller": phase})]
        designs.append(Design({"morphology": other, "controller": turned}))
        as_simulated = [(body, np.float32(phase[body == 3])), (other, np.float32(turned[other == 3]))]
        same = all(np.array_equal(one, another) for one, another in zip(*as_simulated, strict=True))
        [key, another_key] = [Vox().key(design, PAPER) for design in designs]
        assert (key == another_key) == same
        assert Vox().key(designs[0], Record(("tip",))) not in (key, another_key)

    def test_the_key_depends_on_the_shape(self) -> None:
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


def test_an_invalid_design_has_no_key() -> None:
    with pytest.raises(InputError, match=r" uint8\[36\], .* uint8\[X, Y, Z\]") as caught:
        Vox().key(Design({role: array.reshape(-1) for role, array in small().roles.items()}), PAPER)
    assert caught.value.key == "morphology"


def test_a_phase_beyond_single_precision_has_a_key_and_is_rejected_by_the_solver() -> None:
    body = Design({**small().roles, "controller": np.full((4, 3, 3), 1e300)})
    assert Vox().key(body, PAPER)
    with pytest.raises(InputError, match=r"1e6 cycles"):
        Vox().simulate([body], PAPER)


def test_the_error_for_a_sample_after_the_end_contains_the_numbers() -> None:
    with pytest.raises(ConfigurationError) as caught:
        Vox(duration=0.03).check(PAPER)
    for data in ("sample 5 ", " 0.01 s", "simulator.duration = 0.03 s", " 10 steps", " 0 to 2;"):
        assert data in str(caught.value)


def lone(size: int = 2) -> Design:
    material = np.zeros((size, 1, 1), np.uint8)
    material[-1] = 3
    return Design({"morphology": material, "controller": np.zeros(material.shape)})


class TestBodyWithoutBonds:
    """Body whose time step exceeds that of other bodies if voxels are larger than 1 m."""

    vox = Vox(voxel_size=4.0, duration=10.0)

    def test_has_fewer_steps_than_others_if_voxels_are_large(self) -> None:
        with_bond, without = self.vox.simulate([bar(1, 1), lone()], Record(("tip",)))
        assert len(without.steps) < len(with_bond.steps)
        assert without.diverged_at is None

    @pytest.mark.parametrize("vox", [vox, Vox()])
    @pytest.mark.parametrize("every", [0.0, 0.0032, 0.01, 1.0])
    def test_has_every_sample_that_is_accepted(self, vox: Vox, every: float) -> None:
        with pytest.raises(ConfigurationError) as caught:
            vox.check(Record(("tip",), every=every, samples=(10**9,)))
        [last] = map(int, re.findall(r" 0 to (\d+);", str(caught.value)))
        record = Record(("tip",), every=every, samples=(last,))
        vox.check(record)
        for outcome in vox.simulate([bar(1, 1), lone(), lone(1)], record):
            assert len(outcome.steps) == 1

    def test_has_no_sample_after_its_own_end(self) -> None:
        with pytest.raises(InputError, match="beyond"):
            self.vox.simulate([lone()], Record(("tip",), samples=(10**9,)))


def test_a_long_duration_is_checked_quickly() -> None:
    vox = Vox(duration=1e9, step_limit=2**53)
    vox.check(Record(("tip",), every=0.01, samples=(0, 10**10)))
