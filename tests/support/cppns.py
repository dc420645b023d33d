"""Reference networks in plain Python: functions and sums from their formulas, one number at a time."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from types import MappingProxyType
from typing import TypeAlias

import attrs
from neat.activations import ActivationFunctionSet

__all__ = ["LIMIT", "NEAT", "PAPER", "Functions", "Gene", "evaluate"]

Functions: TypeAlias = Mapping[str, Callable[[float], float]]

LIMIT = 1e50


@attrs.frozen
class Gene:
    """A node."""

    activation: str
    bias: float = 0.0
    response: float = 1.0


def _clamp(z: float, limit: float) -> float:
    return max(-limit, min(limit, z))


def guard(z: float) -> float:
    """Return a value clamped to the limit of inputs and outputs of nodes; NaN becomes 0."""
    return 0.0 if math.isnan(z) else _clamp(z, LIMIT)


def _guarded(function: Callable[[float], float]) -> Callable[[float], float]:
    return lambda z: guard(function(guard(z)))


def _inverse(z: float) -> float:
    return 1.0 / z if z else 0.0


_SCALE, _ALPHA = 1.0507009873554804934193349852946, 1.6732632423543772848170429916717

_FORMULAS: Functions = {
    "sigmoid": lambda z: 1.0 / (1.0 + math.exp(-_clamp(5.0 * z, 60.0))),
    "tanh": lambda z: math.tanh(_clamp(2.5 * z, 60.0)),
    "sin": lambda z: math.sin(_clamp(5.0 * z, 60.0)),
    "softplus": lambda z: 0.2 * math.log(1.0 + math.exp(_clamp(5.0 * z, 60.0))),
    "gauss": lambda z: math.exp(-5.0 * math.pow(_clamp(z, 3.4), 2.0)),
    "relu": lambda z: max(0.0, z),
    "elu": lambda z: z if z > 0.0 else math.exp(z) - 1.0,
    "lelu": lambda z: z if z > 0.0 else 0.005 * z,
    "selu": lambda z: _SCALE * z if z > 0.0 else _SCALE * _ALPHA * (math.exp(z) - 1.0),
    "identity": lambda z: z,
    "clamped": lambda z: _clamp(z, 1.0),
    "inv": _inverse,
    "log": lambda z: math.log(max(1e-7, z)),
    "exp": lambda z: math.exp(_clamp(z, 60.0)),
    "abs": abs,
    "hat": lambda z: max(0.0, 1.0 - abs(z)),
    "square": lambda z: math.pow(z, 2.0),
    "cube": lambda z: math.pow(z, 3.0),
    "neg_abs": lambda z: -abs(z),
    "neg_square": lambda z: -math.pow(z, 2.0),
    "sqrt_abs": lambda z: math.sqrt(abs(z)),
    "neg_sqrt_abs": lambda z: -math.sqrt(abs(z)),
    "neg_sin": lambda z: -math.sin(z),
}

PAPER: Functions = MappingProxyType({name: _guarded(formula) for name, formula in _FORMULAS.items()})
"""The 23 functions in the order of the paper's table, with guarded inputs and outputs."""

NEAT: Functions = MappingProxyType(
    {**PAPER, **{name: _guarded(formula) for name, formula in ActivationFunctionSet().functions.items()}}
)
"""The functions of neat-python where it has them, otherwise those of :data:`PAPER`."""


def evaluate(
    outputs: int, nodes: Mapping[int, Gene], links: Iterable[tuple[int, int, float]], point: Sequence[float]
) -> list[float]:
    """Return the outputs of a network at one point, evaluated recursively from each output."""
    arcs = list(links)
    known = {-1 - axis: guard(value) for axis, value in enumerate(point)}

    def value(node: int) -> float:
        if node not in known:
            gene, total = nodes[node], 0.0
            for source, target, weight in arcs:
                if target == node:
                    total += value(source) * weight
            known[node] = PAPER[gene.activation](gene.bias + gene.response * total)
        return known[node]

    return [value(output) for output in range(outputs)]
