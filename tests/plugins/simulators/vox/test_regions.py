"""Boxes in which voxels are clamped: their cells and degrees of freedom."""

from __future__ import annotations

import numpy as np
import pytest
from bars import bar
from hypothesis import given, strategies as st

from evoframe import Record
from evoframe_simulators import FixedRegion, Vox
from evoframe_simulators.vox.regions import DEGREES_OF_FREEDOM, fixed_mask, overlapping


class TestFixedRegions:
    def test_by_default_the_slab_at_x_0_is_clamped(self) -> None:
        mask = fixed_mask([FixedRegion()], (5, 3, 2))
        assert (mask[0] == 63).all()
        assert not mask[1:].any()

    def test_without_regions_the_body_is_free(self) -> None:
        vox = Vox(fixed=(), gravity=-10.0, duration=0.5, self_collision=False, slow_damping=0.0)
        [outcome] = vox.simulate([bar(1, 1)], Record(("body",), initial=True))
        fallen = outcome.tracks["body"][-1, 2] - outcome.tracks["body"][0, 2]
        assert fallen == pytest.approx(-5.0 * outcome.times[-1] ** 2, rel=0.01)

    def test_single_degrees_of_freedom_are_clamped(self) -> None:
        region = FixedRegion(size=(1.0, 1.0, 1.0), degrees_of_freedom=("x", "z"))
        vox = Vox(fixed=(region,), gravity=-10.0, self_collision=False)
        [outcome] = vox.simulate([bar(1, 3)], Record(("tip",), initial=True))
        moved = np.ptp(outcome.tracks["tip"], axis=0)
        assert moved.tolist() == [0.0, 0.0, 0.0]

    @given(
        regions=st.lists(
            st.builds(
                FixedRegion,
                st.tuples(*[st.floats(-0.5, 1.5)] * 3),
                st.tuples(*[st.floats(0, 1.5)] * 3),
                st.sets(st.sampled_from(DEGREES_OF_FREEDOM)).map(tuple),
            ),
            max_size=3,
        ),
        canvas=st.tuples(*[st.integers(1, 4)] * 3),
    )
    def test_a_cell_is_clamped_by_the_regions_that_overlap_it(
        self, regions: list[FixedRegion], canvas: tuple[int, int, int]
    ) -> None:
        expected = np.zeros(canvas, np.uint8)
        for cell in np.ndindex(canvas):
            for region in regions:
                spans = zip(cell, canvas, region.origin, region.size, strict=True)
                if all((i + 1) / n > start and i / n < start + length for i, n, start, length in spans):
                    expected[cell] |= region.bits
        assert (fixed_mask(regions, canvas) == expected).all()

    def test_bits_have_the_order_of_the_engine(self) -> None:
        bits = [FixedRegion(degrees_of_freedom=(freedom,)).bits for freedom in DEGREES_OF_FREEDOM]
        assert bits == [1, 2, 4, 8, 16, 32]


@given(cells=st.integers(1, 50), data=st.data())
def test_a_span_overlaps_the_cells_between_its_ends(cells: int, data: st.DataObject) -> None:
    first = data.draw(st.integers(0, cells - 1))
    last = data.draw(st.integers(first, cells - 1))
    held = overlapping((first + 0.25) / cells, (last - first + 0.5) / cells, cells)
    assert np.flatnonzero(held).tolist() == list(range(first, last + 1))


def test_a_span_does_not_overlap_a_cell_that_it_touches() -> None:
    assert overlapping(0.25, 0.5, 4).tolist() == [False, True, True, False]


@pytest.mark.parametrize("origin", [(np.nan, 0.0, 0.0), (0.0, np.inf, 0.0)])
def test_corners_are_finite(origin: tuple[float, float, float]) -> None:
    with pytest.raises(ValueError, match="'origin'"):
        FixedRegion(origin)
