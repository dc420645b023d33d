"""The champion of a run (its best pair), as a JSON document from which it can be simulated again."""

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
    "joined_key",
    "read_champion",
]

FORMAT = 1
"""Version of champion.json; the run directory has its own."""

_DTYPES = (
    *("bool", "int8", "int16", "int32", "int64", "uint8", "uint16", "uint32", "uint64"),
    *("float16", "float32", "float64"),
)
_CHAMPION_KEYS = {"format", "score", "simulation", "design"}


def _names(simulation: dict[str, Any]) -> str:
    return ", ".join(f"{key}: {table['name']}" for key, table in simulation.items())


@attrs.frozen(eq=False)
class Champion:
    """The best simulated pair.

    Attributes:
        score: Its score by the objective; a displacement in meters with all built-in objectives.
        design: Its body and controller.
        simulation: The tables ``simulator`` and ``objective`` with which it was simulated.
        genomes: Population -> genome, as dumped by the evolver.
    """

    score: float
    design: Design
    simulation: dict[str, Any] = attrs.field(repr=_names)
    genomes: dict[str, Any] = attrs.field(repr=False)


def champion_document(pair: BestPair, simulation: Mapping[str, Any]) -> dict[str, Any]:
    """Return the champion as JSON values, with everything needed to simulate it again on any machine."""
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
        RunError: A role is not an array of finite numbers.
    """
    for role, array in design.roles.items():
        if array.dtype.name not in _DTYPES or not np.isfinite(array).all():
            raise RunError(
                f"expected an array of finite numbers, found {_nature(array)}", key=f"design.{role}"
            )
    return {
        role: {"dtype": array.dtype.name, "shape": list(array.shape), "values": array.ravel().tolist()}
        for role, array in design.roles.items()
    }


def design_from_json(document: Any) -> Design:
    """Return the design that :func:`design_to_json` wrote.

    Raises:
        InputError: The document is not a design; the error's key is the role.
    """
    if not isinstance(document, dict):
        raise InputError(f"expected a table of roles, found {document!r}")
    return Design({role: _array_from_json(role, given) for role, given in document.items()})


def champion_from_json(text: str) -> Champion:
    """Return the champion that :func:`champion_document` wrote.

    Raises:
        InputError: The text is not JSON, or not a champion.
    """
    try:
        document = parsed_json(text)
    except ValueError as error:
        raise InputError(str(error)) from error
    if not isinstance(document, dict) or not document.keys() >= _CHAMPION_KEYS:
        raise InputError("not a champion; expected the champion.json of a run")
    if document["format"] is True or document["format"] != FORMAT:
        hint = "read it with the version of evoframe that wrote it"
        raise InputError(f"expected {FORMAT}, found {document['format']!r}; {hint}", key="format")
    if not isinstance(document["score"], float) or not math.isfinite(document["score"]):
        raise InputError(f"expected a number, found {document['score']!r}", key="score")
    genomes = document.get("genomes", {})
    for key, table in (("simulation", document["simulation"]), ("genomes", genomes)):
        if not isinstance(table, dict):
            raise InputError(f"expected a table, found {table!r}", key=key)
    try:
        design = design_from_json(document["design"])
    except InputError as error:
        raise InputError(error.problem, key=joined_key("design", error.key)) from error
    return Champion(document["score"], design, document["simulation"], genomes)


def read_champion(path: Path) -> Champion:
    """Read the champion in a ``champion.json``.

    Raises:
        InputError: The file cannot be read, or is not a champion.
    """
    text = read_text(path, LARGEST_DOCUMENT)
    try:
        return champion_from_json(text)
    except InputError as error:
        raise InputError(error.problem, source=path, key=error.key) from error


def joined_key(outer: str, inner: str) -> str:
    """Return the dotted key of *inner*, which may be empty, within *outer*."""
    return f"{outer}.{inner}" if inner else outer


def _nature(array: NDArray[Any]) -> str:
    return f"{array.dtype} with NaN or infinity" if array.dtype.name in _DTYPES else str(array.dtype)


def _array_from_json(role: str, given: Any) -> NDArray[Any]:
    """Return an array exactly as written; refuse values that would have to be rounded, wrapped or guessed."""
    try:
        return _exact_array(given["dtype"], given["shape"], given["values"])
    except KeyError as error:
        raise InputError(f"missing {error}", key=role) from error
    except (OverflowError, TypeError, ValueError) as error:
        raise InputError(f"not an array written by evoframe: {error}", key=role) from error


def _exact_array(name: str, shape: Any, values: Any) -> NDArray[Any]:
    if name not in _DTYPES:
        raise ValueError(f"unknown dtype {name!r}; known: {', '.join(_DTYPES)}")
    dtype = np.dtype(name)
    kind = {"b": bool, "f": float}.get(dtype.kind, int)
    if not all(type(value) is kind for value in values):
        raise ValueError(f"expected values of type {name}")
    if not all(type(length) is int and length >= 0 for length in shape):
        raise ValueError(f"expected the lengths of the axes, found the shape {shape}")
    array = np.array(values, dtype=dtype)
    if array.tolist() != values:
        raise ValueError(f"{name} cannot represent the values")
    return array.reshape(shape)
