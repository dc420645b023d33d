"""Choice of the objective for bodies of files with their own settings."""

from __future__ import annotations

from typing import Any

import attrs
import numpy as np
import pytest
from hypothesis import given, strategies as st
from hypothesis.extra.numpy import arrays

from evoframe import Design, Record
from evoframe_objectives import evoframe_objectives
from evoframe_simulators import FixedRegion, Vox
from evoframe_simulators.vox.objectives import motion_of, objective_of

FREE = Vox(fixed=())
BAR = np.ones((4, 2, 2), np.uint8)
TOP = FixedRegion(origin=(0.0, 0.0, 0.9), size=(1.0, 1.0, 0.1))
FRONT = FixedRegion(origin=(0.9, 0.0, 0.0), size=(0.1, 1.0, 1.0))
ROLLER = FixedRegion(size=(1.0, 1.0, 1.0), degrees_of_freedom=("z", "rx"))
RAIL = FixedRegion(size=(1.0, 1.0, 1.0), degrees_of_freedom=("x", "y"))
CEILING = FixedRegion(size=(1.0, 1.0, 1.0), degrees_of_freedom=("z",))
SLIDE = FixedRegion(degrees_of_freedom=("x", "z"))
GUIDE = FixedRegion(origin=(0.9, 0.0, 0.0), size=(0.1, 0.5, 0.5), degrees_of_freedom=("y",))
HINGE = FixedRegion(degrees_of_freedom=("x", "y", "z"))


def with_a_tower() -> Any:
    """Return a bar with a voxel above its first one, so that the tip is not in the face."""
    material = np.zeros((4, 1, 2), np.uint8)
    material[:, 0, 0] = material[0, 0, 1] = 1
    return material


@pytest.mark.parametrize(
    ("settings", "material", "motion"),
    [
        (Vox(), BAR, "face"),
        (Vox(fixed=(HINGE,)), BAR, "face"),
        (Vox(fixed=(TOP,)), BAR, "face"),
        (Vox(fixed=(FRONT,)), BAR, "body"),
        (Vox(fixed=(FRONT,)), with_a_tower(), "tip"),
        (Vox(fixed=(ROLLER,)), BAR, "body"),
        (Vox(fixed=(RAIL,)), BAR, "face"),
        (Vox(fixed=(RAIL, CEILING)), BAR, "body"),
        (Vox(fixed=(SLIDE,)), BAR, "body"),
        (Vox(fixed=(SLIDE, GUIDE)), BAR, "face"),
        (FREE, BAR, "body"),
    ],
)
def test_the_motion_is_that_of_a_point_that_is_not_held(settings: Vox, material: Any, motion: str) -> None:
    assert motion_of(settings, material) == motion


def test_a_region_without_voxels_holds_nothing() -> None:
    material = BAR.copy()
    material[0] = 0
    assert motion_of(Vox(), material) == "body"


bodies = arrays(np.uint8, st.tuples(*[st.integers(1, 4)] * 3), elements=st.sampled_from([0, 1, 3]))
regions = st.builds(
    FixedRegion,
    origin=st.tuples(*[st.floats(0, 1)] * 3),
    size=st.tuples(*[st.floats(0, 1)] * 3),
    degrees_of_freedom=st.sampled_from([("x", "y", "z"), ("x", "y"), ("x", "y", "z", "rx", "ry", "rz")]),
)


@given(material=bodies.filter(np.any), fixed=st.lists(regions, max_size=2))
def test_the_point_is_free_to_move(material: Any, fixed: list[FixedRegion]) -> None:
    """Gravity moves the point, unless it is the center of a body that is held everywhere."""
    vox = Vox(fixed=tuple(fixed), duration=0.02, gravity=-9.81)
    motion = motion_of(vox, material)
    design = Design({"morphology": material, "controller": np.zeros(material.shape)})
    [outcome] = vox.simulate([design], Record(("voxels", motion), initial=True))
    start, end = outcome.tracks[motion][[0, -1]]
    voxels = outcome.tracks["voxels"][:, material > 0]
    assert (start != end).any() or (motion == "body" and (voxels[0] == voxels[-1]).all())


@given(material=bodies.filter(np.any))
def test_the_tip_is_the_point_that_the_solver_tracks(material: Any) -> None:
    """Holding exactly the voxel that the solver calls the tip changes the choice between tip and body."""
    design = Design({"morphology": material, "controller": np.zeros(material.shape)})
    [outcome] = FREE.simulate([design], Record(("tip",), initial=True, samples=()))
    cell = np.floor(outcome.tracks["tip"][0] / FREE.voxel_size).astype(int)
    canvas = np.array(material.shape)
    face = np.argwhere(material)[:, 0].max()
    slab = FixedRegion(origin=((face + 0.5) / canvas[0], 0.0, 0.0), size=(0.4 / canvas[0], 1.0, 1.0))
    tip = FixedRegion(origin=tuple((cell + 0.4) / canvas), size=tuple(0.2 / canvas))
    assert motion_of(Vox(fixed=(slab, tip)), material) == "body"
    assert motion_of(Vox(fixed=(slab,)), material) == ("body" if cell[0] == face else "tip")


class TestObjective:
    def test_of_a_held_body_is_its_displacement_from_the_first_step_to_the_last(self) -> None:
        expected = {"name": "face-yz", "every": 0.0, "first": 0, "last": -1}
        assert objective_of(Vox(), [BAR]) == expected
        assert objective_of(Vox(fixed=(FRONT,)), [with_a_tower()]) == {**expected, "name": "tip-yz"}

    def test_of_a_free_body_is_its_travel_during_the_contraction(self) -> None:
        settings = attrs.evolve(FREE, start_time=0.02)
        expected = {"name": "travel", "along": "xy", "every": 0.0}
        assert objective_of(settings, [BAR]) == {**expected, "after": 0.02}
        assert objective_of(attrs.evolve(settings, start_time=0.07), [BAR]) == {**expected, "after": 0.0}

    def test_of_a_very_long_simulation_has_a_bounded_number_of_samples(self) -> None:
        long = attrs.evolve(FREE, duration=5e4, step_limit=10**12)
        table = objective_of(long, [BAR])
        assert table["every"] == 0.05
        steps = Vox(duration=5e4, step_limit=10**12, fixed=()).duration_of(
            Design({"morphology": BAR, "controller": np.zeros(BAR.shape)})
        )
        assert 9e5 < steps / table["every"] < 1.1e6

    def test_of_several_bodies_fits_all(self) -> None:
        short = BAR.copy()
        short[0] = 0
        empty = np.zeros_like(BAR)
        assert objective_of(Vox(), [BAR, empty, BAR])["name"] == "face-yz"
        assert objective_of(Vox(), [BAR, short])["name"] == "travel"
        assert objective_of(Vox(), [empty])["name"] == "travel"

    @pytest.mark.parametrize("duration", [0.0033, 0.07, 0.3])
    @pytest.mark.parametrize("fixed", [(), (FixedRegion(),), (FRONT,)])
    @pytest.mark.parametrize("start", [0.0, 0.003, 0.069, 5.0])
    def test_has_samples_in_every_simulation(self, duration: float, fixed: Any, start: float) -> None:
        vox = Vox(duration=duration, fixed=fixed, start_time=start)
        design = Design({"morphology": BAR, "controller": np.zeros(BAR.shape)})
        table = vox.objective_for([design])
        options = {key: value for key, value in table.items() if key != "name"}
        objective = evoframe_objectives()[table["name"]](**options)
        vox.check(objective.record)
        [outcome] = vox.simulate([design], objective.record)
        assert objective.window(outcome.times)[1] == vox.duration_of(design)  # type: ignore[attr-defined]
