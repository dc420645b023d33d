"""Regions in VXA files clamp the same cells in the arithmetic of the engine and of ``vox``."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from bars import bar
from hypothesis import example, given, strategies as st
from numpy.typing import NDArray

from evoframe_simulators import FixedRegion, Vox
from evoframe_simulators.vox.regions import fixed_mask
from evoframe_simulators.vox.vxa import read_vxa
from evoframe_simulators.vox.vxa.cells import Lattice, as_engine_holds, as_vox_holds

Write = Callable[..., Path]


def engine_mask(region: FixedRegion, lattice: Lattice) -> NDArray[np.bool_]:
    """Return a mask of the cells that a region clamps in the engine."""
    held = []
    for start, length, cells in zip(region.origin, region.size, lattice.canvas, strict=True):
        place = lattice.edge * (np.arange(cells) + 0.5) / (lattice.edge * cells)
        half = (lattice.edge / 2) / (lattice.edge * cells)
        held.append((place + half > start) & (place - half < start + length))
    mask = np.zeros(lattice.canvas, np.bool_)
    mask[np.ix_(*held)] = True
    return mask


def vox_mask(region: FixedRegion, lattice: Lattice) -> NDArray[np.bool_]:
    return fixed_mask([region], lattice.canvas) > 0


def mask_of(region: FixedRegion | None, lattice: Lattice) -> NDArray[np.bool_]:
    """Return a mask of the cells that a region clamps in both arithmetics."""
    if region is None:
        return np.zeros(lattice.canvas, np.bool_)
    engine, vox = engine_mask(region, lattice), vox_mask(region, lattice)
    assert (engine == vox).all()
    assert engine.any()
    return vox


lattices = st.builds(
    Lattice,
    canvas=st.tuples(*[st.integers(1, 60)] * 3),
    edge=st.sampled_from([0.001, 0.01, 0.03, 0.05, 0.1, 0.7, 1.0]) | st.floats(1e-6, 1e3),
)


@st.composite
def faces_on_cells(draw: st.DrawFn, lattice: Lattice) -> FixedRegion:
    """Draw a region whose faces lie between cells, up to rounding."""
    firsts = [draw(st.integers(0, cells - 1)) for cells in lattice.canvas]
    lasts = [draw(st.integers(first, n - 1)) for first, n in zip(firsts, lattice.canvas, strict=True)]
    pairs = zip(firsts, lasts, lattice.canvas, strict=True)
    spans = [(first / n, draw(st.sampled_from([(last + 1 - first) / n, 0.0]))) for first, last, n in pairs]
    (x, dx), (y, dy), (z, dz) = spans
    return FixedRegion((x, y, z), (dx, dy, dz))


anywhere = st.builds(
    FixedRegion, origin=st.tuples(*[st.floats(-1, 2)] * 3), size=st.tuples(*[st.floats(0, 2)] * 3)
)
cases = lattices.flatmap(lambda lattice: st.tuples(st.just(lattice), faces_on_cells(lattice) | anywhere))

ODD = Lattice((20, 1, 1), 0.01), FixedRegion((0.0, 0.0, 0.0), (0.35, 1.0, 1.0))
"""Region with a face between two cells, of which the engine clamps one cell more."""


def test_the_arithmetics_differ_if_a_face_lies_between_cells() -> None:
    lattice, region = ODD
    assert np.flatnonzero(engine_mask(region, lattice)).tolist() == list(range(8))
    assert np.flatnonzero(vox_mask(region, lattice)).tolist() == list(range(7))


@given(case=cases)
@example(case=ODD)
def test_a_written_region_clamps_the_cells_of_vox_in_both(case: tuple[Lattice, FixedRegion]) -> None:
    lattice, region = case
    held = mask_of(as_vox_holds(region, lattice.canvas), lattice)
    assert (held == vox_mask(region, lattice)).all()


@given(case=cases)
@example(case=ODD)
def test_a_region_that_was_read_clamps_the_cells_of_the_engine_in_both(
    case: tuple[Lattice, FixedRegion],
) -> None:
    lattice, region = case
    held = mask_of(as_engine_holds(region, lattice), lattice)
    assert (held == engine_mask(region, lattice)).all()


@given(data=st.data(), lattice=lattices)
def test_every_span_of_cells_can_be_expressed(data: st.DataObject, lattice: Lattice) -> None:
    spans = [sorted(data.draw(st.tuples(*[st.integers(0, n - 1)] * 2))) for n in lattice.canvas]
    x, y, z = ((first + 0.25) / n for (first, _), n in zip(spans, lattice.canvas, strict=True))
    dx, dy, dz = ((last - first + 0.5) / n for (first, last), n in zip(spans, lattice.canvas, strict=True))
    expected = np.zeros(lattice.canvas, np.bool_)
    expected[tuple(slice(first, last + 1) for first, last in spans)] = True
    written = as_vox_holds(FixedRegion((x, y, z), (dx, dy, dz), ("x", "rz")), lattice.canvas)
    assert (mask_of(written, lattice) == expected).all()
    assert written is not None
    assert written.degrees_of_freedom == ("x", "rz")
    assert as_engine_holds(written, lattice) == written  # repeated reading and writing changes nothing


def test_the_default_is_the_slab_in_both() -> None:
    lattice = Lattice((6, 3, 3), 0.05)
    written = as_vox_holds(FixedRegion(), lattice.canvas)
    assert written is not None
    assert (written.origin[0], written.size[0]) == (0.5 / 6, 0.0)
    assert mask_of(written, lattice).tolist() == [[[x == 0] * 3] * 3 for x in range(6)]


def test_a_long_canvas_is_fast() -> None:
    lattice = Lattice((2**24, 1, 1), 0.01)
    region = FixedRegion((0.25, 0.0, 0.0), (0.5, 1.0, 1.0))
    for _ in range(10_000):
        held = as_engine_holds(region, lattice)
    assert held is not None
    first, length = held.origin[0] * 2**24, held.size[0] * 2**24
    assert first == pytest.approx(2**22, abs=2)
    assert length == pytest.approx(2**23, abs=3)


def test_a_face_between_cells_is_written_for_the_engine(tmp_path: Path) -> None:
    lattice, region = ODD
    vox = Vox(fixed=(region,), voxel_size=lattice.edge)
    path = tmp_path / "a.vxa"
    path.write_bytes(vox.export(bar(*[1] * 20), "vxa").data)
    [again] = read_vxa(path).options["fixed"]
    assert np.flatnonzero(mask_of(again, lattice)).tolist() == list(range(7))
    text = path.read_text()
    assert f"<X>{0.5 / 20!r}</X>" in text
    assert f"<dX>{6 / 20!r}</dX>" in text


def test_a_face_between_cells_is_read_as_the_engine_does(vxa: Write) -> None:
    lattice, _ = ODD
    row = f"<Layer>{'1' * 20}</Layer>"
    path = vxa("voxcad", X_Voxels=20, dX=0.35)
    text = path.read_text().replace("<Layer>11111</Layer>", row)
    path.write_text(text.replace("<Lattice>", "<Lattice><Lattice_Dim>0.01</Lattice_Dim>"))
    held = [np.flatnonzero(mask_of(region, lattice)).tolist() for region in read_vxa(path).options["fixed"]]
    assert held == [list(range(8)), [19]]
