"""Body of a VXA file: layers of characters and of offsets."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, strategies as st
from hypothesis.extra import numpy as arrays
from lxml import etree
from numpy.typing import NDArray

from evoframe import InputError
from evoframe_simulators.vox.vxa.sections import Section
from evoframe_simulators.vox.vxa.structure import read_canvas, read_material, read_phase

canvases = st.tuples(*[st.integers(1, 4)] * 3)


def structure(data: list[str], tag: str = "Data") -> Section:
    """Return a structure with one layer per text."""
    section = etree.Element("Structure")
    parent = etree.SubElement(section, tag)
    for text in data:
        etree.SubElement(parent, "Layer").text = text
    return Section(section, "Structure")


def layers(cells: NDArray[np.generic]) -> list[list[str]]:
    """Return the cells of each z as text, x fastest."""
    x, y, z = cells.shape
    return [[str(cells[i, j, k]) for j in range(y) for i in range(x)] for k in range(z)]


@given(material=canvases.flatmap(lambda shape: arrays.arrays(np.uint8, shape, elements=st.integers(0, 60))))
def test_cells_are_read_x_fastest_then_y_then_z(material: NDArray[np.uint8]) -> None:
    material[0, 0, 0] = 1
    texts = ["".join(chr(48 + int(code)) for code in layer) for layer in layers(material)]
    x, y, z = material.shape
    read = read_material(structure(texts), (x, y, z), 60)
    assert read.dtype == np.uint8
    assert (read == material).all()


@given(
    phase=canvases.flatmap(lambda shape: arrays.arrays(np.float64, shape, elements=st.floats(-1e6, 1e6))),
    end=st.sampled_from(["", ","]),
)
def test_written_offsets_are_read_exactly(phase: NDArray[np.float64], end: str) -> None:
    texts = [", ".join(layer) + end for layer in layers(phase)]
    x, y, z = phase.shape
    assert (read_phase(structure(texts, "PhaseOffset"), (x, y, z)) == phase).all()


def test_missing_offsets_are_0() -> None:
    assert (read_phase(structure(["1"]), (2, 1, 3)) == np.zeros((2, 1, 3))).all()


@pytest.mark.parametrize(
    ("data", "key", "problem"),
    [
        (["11"], "Structure/Data", r" 1 layers, .* Z_Voxels = 2$"),
        (["11", "1"], "Structure/Data/Layer 2", r" 1 cells, expected 2 .* 2 x 1\)$"),
        (
            ["11", "1:"],
            "Structure/Data/Layer 2",
            r"cell 2 ':' .* 10, .* 9, ",
        ),
        (
            ["1/", "11"],
            "Structure/Data/Layer 1",
            r"cell 2 '/' .* -1, .* 9, ",
        ),
        (["00", "00"], "Structure", "no voxels"),
    ],
)
def test_the_error_for_invalid_cells_names_their_layer(data: list[str], key: str, problem: str) -> None:
    with pytest.raises(InputError, match=problem) as caught:
        read_material(structure(data), (2, 1, 2), 9)
    assert caught.value.key == key


@pytest.mark.parametrize(
    ("data", "key", "problem"),
    [
        (["0,0,0"], "Structure/PhaseOffset/Layer 1", " 3 offsets, .* 2 x 1 with commas between them$"),
        (["0,"], "Structure/PhaseOffset/Layer 1", " 1 offset, .* 2 x 1 with commas between them$"),
        (["0 0.5"], "Structure/PhaseOffset/Layer 1", " 1 offset, .* 2 x 1 with commas .*, found blanks$"),
        (["0,x"], "Structure/PhaseOffset/Layer 1", "offset 'x'"),
        (["0,1e7"], "Structure/PhaseOffset", r" 1e\+07 .* 1e\+06$"),
    ],
)
def test_the_error_for_invalid_offsets_names_their_layer(data: list[str], key: str, problem: str) -> None:
    with pytest.raises(InputError, match=problem) as caught:
        read_phase(structure(data, "PhaseOffset"), (2, 1, 1))
    assert caught.value.key == key


def test_a_canvas_has_at_most_the_cells_that_the_solver_accepts() -> None:
    def lengths(*voxels: int) -> Section:
        text = "".join(f"<{axis}_Voxels>{n}</{axis}_Voxels>" for axis, n in zip("XYZ", voxels, strict=True))
        return Section(etree.fromstring(f"<Structure>{text}</Structure>"), "Structure")

    assert read_canvas(lengths(2**8, 2**8, 2**8)) == (2**8, 2**8, 2**8)
    with pytest.raises(InputError, match=r" 16777217 x 1 x 1 = 16777217 cells, .* 16777216$") as caught:
        read_canvas(lengths(2**24 + 1, 1, 1))
    assert caught.value.key == "Structure"
