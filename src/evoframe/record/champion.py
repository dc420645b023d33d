"""The champion: the best pair that was really simulated, as a document that simulates it again."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

from evoframe.contract import BestPair, Design
from evoframe.errors import InputError, RunError
from evoframe.files import LARGEST_DOCUMENT, parsed_json, read_text

__all__ = [
    "FORMAT",
    "Champion",
    "champion_document",
    "champion_from_json",
    "design_from_json",
    "design_to_json",
    "read_champion",
]

FORMAT = 1
"""Version of the champion's document; that of the run directory is another."""

_DTYPES = (
    *("bool", "int8", "int16", "int32", "int64", "uint8", "uint16", "uint32", "uint64"),
    *("float16", "float32", "float64"),
)
_CHAMPION_KEYS = {"format", "score", "simulation", "design"}


@attrs.frozen(eq=False)
class Champion:
    """The best pair that was really simulated.

    Attributes:
        score: What the objective gave; a displacement in metres with all built-in objectives.
        design: Body and controller.
        simulation: The tables ``simulator`` and ``objective`` that it was simulated with.
        genomes: Population -> its genome, as its evolver dumps it.
    """

    score: float
    design: Design
    simulation: dict[str, Any]
    genomes: dict[str, Any] = attrs.field(repr=False)


def champion_document(pair: BestPair, simulation: Mapping[str, Any]) -> dict[str, Any]:
    """Return all that is needed to simulate the champion again, and nothing of this machine, as JSON."""
    return {
        "format": FORMAT,
        "score": pair.score,
        "turn": pair.turn,
        "genome_ids": dict(pair.genome_ids),
        "simulation": simulation,
        "design": design_to_json(pair.design),
        "genomes": dict(pair.genomes),
    }


def design_to_json(design: Design) -> dict[str, Any]:
    """Return a design as JSON values, exact to the last bit.

    Raises:
        RunError: A role is no array of finite numbers.
    """
    for role, array in design.roles.items():
        if array.dtype.name not in _DTYPES or not np.isfinite(array).all():
            raise RunError(f"the design's role '{role}' is no array of finite numbers, but {array.dtype}")
    return {
        role: {"dtype": array.dtype.name, "shape": list(array.shape), "values": array.ravel().tolist()}
        for role, array in design.roles.items()
    }


def design_from_json(document: Any) -> Design:
    """Return the design that :func:`design_to_json` described.

    Raises:
        ValueError: It is not such a document.
    """
    if not isinstance(document, dict):
        raise ValueError("expected a table of roles")  # noqa: TRY004 - it is a bad document
    return Design({role: _array_from_json(role, given) for role, given in document.items()})


def champion_from_json(text: str) -> Champion:
    """Return the champion that :func:`champion_document` described.

    Raises:
        ValueError: The text is not JSON, or no champion; says why.
    """
    document = parsed_json(text)
    if not isinstance(document, dict) or not document.keys() >= _CHAMPION_KEYS:
        raise ValueError("this JSON is no champion of evoframe; expected a run's champion.json")
    if document["format"] is True or document["format"] != FORMAT:
        raise ValueError(f"format {document['format']!r}, but this evoframe reads format {FORMAT}")
    if not isinstance(document["score"], float) or not math.isfinite(document["score"]):
        raise ValueError(f"score: expected a number, found {document['score']!r}")
    genomes = document.get("genomes", {})
    for key, table in (("simulation", document["simulation"]), ("genomes", genomes)):
        if not isinstance(table, dict):
            raise ValueError(f"{key}: expected a table, found {table!r}")  # noqa: TRY004 - it is a bad document
    try:
        design = design_from_json(document["design"])
    except (KeyError, OverflowError, TypeError, ValueError) as error:
        raise ValueError(f"design: not as evoframe writes it: {error}") from error
    return Champion(document["score"], design, document["simulation"], genomes)


def read_champion(path: Path) -> Champion:
    """Return what :func:`champion_from_json` finds in a ``champion.json``.

    Raises:
        InputError: The file cannot be read, or is no champion.
    """
    text = read_text(path, LARGEST_DOCUMENT)
    try:
        return champion_from_json(text)
    except ValueError as error:
        raise InputError(f"{path}: {error}") from error


def _array_from_json(role: str, given: Any) -> NDArray[Any]:
    """Return an array, exactly as it is written: nothing is rounded, wrapped or guessed."""
    name, shape, values = given["dtype"], given["shape"], given["values"]
    if name not in _DTYPES:
        raise ValueError(f"{role}: unknown dtype {name!r}; known: {', '.join(_DTYPES)}")
    dtype = np.dtype(name)
    kind = {"b": bool, "f": float}.get(dtype.kind, int)
    if not all(type(value) is kind for value in values):
        raise ValueError(f"{role}: expected values of type {name}")
    if not all(type(length) is int and length >= 0 for length in shape):
        raise ValueError(f"{role}: expected the lengths of axes, found the shape {shape}")
    array = np.array(values, dtype=dtype)
    if array.tolist() != values:
        raise ValueError(f"{role}: {name} cannot hold the values")
    return array.reshape(shape)
