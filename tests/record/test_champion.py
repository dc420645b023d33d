"""The champion's document is read back exactly, and any other document is refused."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, strategies as st
from hypothesis.extra.numpy import array_shapes, arrays
from numpy.typing import NDArray
from turns import best_pairs

from evoframe import BestPair, Design, InputError, RunConfig, RunError, run
from evoframe.files.writing import json_text
from evoframe.record.champion import (
    champion_document,
    champion_from_json,
    design_from_json,
    design_to_json,
    read_champion,
)

Load = Callable[..., RunConfig]


def with_array(**array: Any) -> Callable[[dict[str, Any]], dict[str, Any]]:
    """Return a change of a champion's document that replaces its design."""
    return lambda document: {**document, "design": {"a": array}}


class TestChampionFile:
    @pytest.fixture
    def champion(self, toy_config: Load, tmp_path: Path) -> Path:
        return run(toy_config(), out=tmp_path / "run").directory / "champion.json"

    def test_is_read_back_exactly(self, champion: Path) -> None:
        found = read_champion(champion)
        design = found.design
        assert found.simulation == {
            "simulator": {"name": "toy-product", "limit": 1e9},
            "objective": {"name": "toy-value"},
        }
        assert design.roles["a"][0] * design.roles["b"][0] == found.score
        again = design_from_json(design_to_json(design))
        assert all((again.roles[role] == array).all() for role, array in design.roles.items())

    @pytest.mark.parametrize(
        ("change", "key", "data"),
        [
            (lambda d: [d], "", ""),
            (lambda d: {}, "", ""),
            (lambda d: {**d, "format": 2}, "format", "2"),
            (lambda d: {**d, "score": "high"}, "score", "'high'"),
            (lambda d: {**d, "design": []}, "design", "[]"),
            (with_array(dtype="object", shape=[1], values=[1]), "design.a", "'object'"),
            (with_array(dtype="float64", shape=[2], values=[1.0]), "design.a", "(2,)"),
            (with_array(dtype="uint8", shape=[1], values=[-5]), "design.a", "uint8"),
            (with_array(dtype="float64", shape=[1], values=["x"]), "design.a", "float64"),
            (with_array(dtype="float64", values=[1.0]), "design.a", "'shape'"),
        ],
    )
    def test_that_was_changed_is_refused_with_its_name(
        self, champion: Path, change: Callable[[Any], Any], key: str, data: str
    ) -> None:
        champion.write_text(json.dumps(change(json.loads(champion.read_text()))))
        with pytest.raises(InputError) as caught:
            read_champion(champion)
        assert (caught.value.source, caught.value.key) == (str(champion), key)
        assert data in caught.value.problem

    @pytest.mark.parametrize("text", ["", "{", "nope", "[" * 50])
    def test_that_is_not_json_is_refused(self, champion: Path, text: str) -> None:
        champion.write_text(text)
        with pytest.raises(InputError, match="JSON") as caught:
            read_champion(champion)
        assert (caught.value.source, caught.value.key) == (str(champion), "")


@given(
    arrays(
        st.sampled_from(["bool", "int8", "int64", "uint8", "uint64", "float16", "float32", "float64"]),
        array_shapes(max_dims=3, max_side=4),
        elements={"allow_nan": False, "allow_infinity": False},
    )
)
def test_any_design_of_numbers_survives_its_json(array: NDArray[Any]) -> None:
    document = json.loads(json.dumps(design_to_json(Design({"a": array}))))
    again = design_from_json(document).roles["a"]
    assert (again.dtype, again.tobytes()) == (array.dtype, array.tobytes())


@pytest.mark.parametrize(("value", "dtype"), [(np.nan, "float64"), (1j, "complex128")])
def test_a_design_that_is_not_an_array_of_finite_numbers_is_not_saved(value: complex, dtype: str) -> None:
    with pytest.raises(RunError, match=dtype) as caught:
        design_to_json(Design({"a": np.array([value])}))
    assert caught.value.key == "design.a"


@given(best_pairs())
def test_a_champion_equals_its_document(pair: BestPair) -> None:
    simulation = {"simulator": {"name": "toy-product", "limit": 2.5}, "objective": {"name": "toy-value"}}
    champion = champion_from_json(json_text(champion_document(pair, simulation)))
    assert (champion.score, champion.genomes, champion.simulation) == (pair.score, pair.genomes, simulation)
    assert design_to_json(champion.design) == design_to_json(pair.design)


@pytest.mark.parametrize(
    ("given_array", "data"),
    [
        ({"dtype": "uint8", "shape": [1], "values": [256]}, "uint8"),
        ({"dtype": "float32", "shape": [1], "values": [0.1]}, "float32"),
        ({"dtype": "float64", "shape": [1], "values": [1]}, "float64"),
        ({"dtype": "int64", "shape": [1], "values": [True]}, "int64"),
        ({"dtype": "int64", "shape": [-1], "values": [1, 2]}, r"\[-1\]"),
        ({"dtype": "int64", "shape": [True], "values": [1]}, r"\[True\]"),
    ],
)
def test_nothing_is_rounded_wrapped_or_guessed(given_array: dict[str, Any], data: str) -> None:
    with pytest.raises(InputError, match=data) as caught:
        design_from_json({"a": given_array})
    assert caught.value.key == "a"


@pytest.mark.parametrize(
    ("key", "value"), [("format", True), ("score", 1), ("genomes", []), ("simulation", None)]
)
def test_a_document_with_values_of_wrong_types_is_not_a_champion(key: str, value: Any) -> None:
    pair = BestPair(0, 0.5, {}, {}, Design({}))
    with pytest.raises(InputError) as caught:
        champion_from_json(json.dumps({**champion_document(pair, {}), key: value}))
    assert caught.value.key == key
    assert repr(value) in caught.value.problem
