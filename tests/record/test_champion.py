"""The champion's document: read back exactly, and nothing else is taken for it."""

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
        ("change", "message"),
        [
            (lambda d: [d], "this JSON is no champion"),
            (lambda d: {}, "this JSON is no champion"),
            (lambda d: {**d, "format": 2}, "format 2, but this evoframe reads format 1"),
            (lambda d: {**d, "score": "high"}, "score: expected a number, found 'high'"),
            (lambda d: {**d, "design": []}, "design: not as evoframe writes it"),
            (
                lambda d: {**d, "design": {"a": {"dtype": "object", "shape": [1], "values": [1]}}},
                "unknown dtype",
            ),
            (
                lambda d: {**d, "design": {"a": {"dtype": "float64", "shape": [2], "values": [1.0]}}},
                "cannot reshape",
            ),
            (
                lambda d: {**d, "design": {"a": {"dtype": "uint8", "shape": [1], "values": [-5]}}},
                "design: not as",
            ),
            (
                lambda d: {**d, "design": {"a": {"dtype": "float64", "shape": [1], "values": ["x"]}}},
                "design: not as",
            ),
        ],
    )
    def test_that_was_changed_is_refused_with_its_name(
        self, champion: Path, change: Callable[[Any], Any], message: str
    ) -> None:
        champion.write_text(json.dumps(change(json.loads(champion.read_text()))))
        with pytest.raises(InputError, match=rf"champion\.json: .*{message}"):
            read_champion(champion)

    @pytest.mark.parametrize("text", ["", "{", "nope", "[" * 100_000])
    def test_that_is_no_json_is_refused(self, champion: Path, text: str) -> None:
        champion.write_text(text)
        with pytest.raises(InputError, match="not valid JSON"):
            read_champion(champion)


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


def test_a_design_that_is_no_array_of_numbers_is_refused_when_it_is_recorded() -> None:
    with pytest.raises(RunError, match="the design's role 'a' is no array of finite numbers, but float64"):
        design_to_json(Design({"a": np.array([np.nan])}))
    with pytest.raises(RunError, match="but complex128"):
        design_to_json(Design({"a": np.array([1j])}))


@given(best_pairs())
def test_a_champion_is_what_its_document_says(pair: BestPair) -> None:
    simulation = {"simulator": {"name": "toy-product", "limit": 2.5}, "objective": {"name": "toy-value"}}
    champion = champion_from_json(json_text(champion_document(pair, simulation)))
    assert (champion.score, champion.genomes, champion.simulation) == (pair.score, pair.genomes, simulation)
    assert design_to_json(champion.design) == design_to_json(pair.design)


@pytest.mark.parametrize(
    ("given_array", "message"),
    [
        ({"dtype": "uint8", "shape": [1], "values": [256]}, "a: uint8 cannot hold|out of bounds"),
        ({"dtype": "float32", "shape": [1], "values": [0.1]}, "a: float32 cannot hold the values"),
        ({"dtype": "float64", "shape": [1], "values": [1]}, "a: expected values of type float64"),
        ({"dtype": "int64", "shape": [1], "values": [True]}, "a: expected values of type int64"),
        ({"dtype": "int64", "shape": [-1], "values": [1, 2]}, "a: expected the lengths of axes"),
        ({"dtype": "int64", "shape": [True], "values": [1]}, "a: expected the lengths of axes"),
    ],
)
def test_nothing_is_rounded_wrapped_or_guessed(given_array: dict[str, Any], message: str) -> None:
    with pytest.raises((ValueError, OverflowError), match=message):
        design_from_json({"a": given_array})


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"format": True}, "format True, but"),
        ({"score": 1}, "score: expected a number"),
        ({"genomes": []}, "genomes: expected a table"),
    ],
)
def test_a_document_with_other_kinds_of_values_is_no_champion(change: dict[str, Any], message: str) -> None:
    pair = BestPair(0, 0.5, {}, {}, Design({}))
    document = {**champion_document(pair, {}), **change}
    with pytest.raises(ValueError, match=message):
        champion_from_json(json.dumps(document))
