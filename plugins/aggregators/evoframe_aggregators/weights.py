"""Weights of sorted scores: the paper's table, and generators for any number of scores.

Residuals of the generators, each with its best parameter, against the 27 weights of the paper's table (2, 3,
5, 7 and 10 collaborators):

===================  ==============  ========  ======
generator            best parameter   largest     rms
===================  ==============  ========  ======
``geometric``                0.6676    0.0442  0.0175
``rank-reciprocal``          0.8642    0.0791  0.0317
``rank-exponent``            1.1621    0.1051  0.0438
``quantifier``               0.5808    0.1054  0.0482
``centroid``                           0.1500  0.0519
equal weights                          0.2071  0.1083
===================  ==============  ========  ======

So ``geometric`` continues the table, with the simple ratio 2/3 (0.0441, 0.0175), which gives the paper's
weights of two collaborators exactly.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Literal, TypeAlias

import attrs

__all__ = [
    "GENERATORS",
    "PAPER_WEIGHTS",
    "Generator",
    "GeneratorName",
    "generated_weights",
    "require_weights",
]

PAPER_WEIGHTS: Mapping[int, tuple[float, ...]] = MappingProxyType(
    {
        2: (0.6, 0.4),
        3: (0.5, 0.3, 0.2),
        5: (0.4, 0.3, 0.15, 0.1, 0.05),
        7: (0.35, 0.25, 0.15, 0.12, 0.07, 0.04, 0.02),
        10: (0.3, 0.2, 0.15, 0.12, 0.08, 0.05, 0.04, 0.03, 0.02, 0.01),
    }
)
"""Number of collaborators -> weights of the sorted scores, the largest score first (the paper's table)."""

GeneratorName: TypeAlias = Literal["geometric", "rank-reciprocal", "rank-exponent", "quantifier", "centroid"]
"""Name of a generator of weights."""


@attrs.frozen
class Generator:
    """A family of weights for any number of scores.

    Attributes:
        shares: Returns numbers in proportion to the weights of n scores, the largest score first: finite and
            non-negative, the largest of them far from overflow and underflow.
        parameter: Default of its parameter; ``None`` if it has none.
    """

    shares: Callable[[int, float], list[float]]
    parameter: float | None


def _geometric(n: int, ratio: float) -> list[float]:
    if ratio > 1:  # from the last one on, so that no power overflows
        return [(1 / ratio) ** k for k in reversed(range(n))]
    return [ratio**k for k in range(n)]


def _rank_reciprocal(n: int, exponent: float) -> list[float]:
    return [(1 / rank) ** exponent for rank in range(1, n + 1)]


def _rank_exponent(n: int, exponent: float) -> list[float]:
    return [((n + 1 - rank) / n) ** exponent for rank in range(1, n + 1)]


def _quantifier(n: int, exponent: float) -> list[float]:
    reached = [0.0, *((rank / n) ** exponent for rank in range(1, n + 1))]
    return [max(after - before, 0.0) for before, after in itertools.pairwise(reached)]


def _centroid(n: int, _: float) -> list[float]:
    return [math.fsum(1 / rank for rank in range(first, n + 1)) for first in range(1, n + 1)]


GENERATORS: Mapping[GeneratorName, Generator] = MappingProxyType(
    {
        "geometric": Generator(_geometric, 2 / 3),
        "rank-reciprocal": Generator(_rank_reciprocal, 1.0),
        "rank-exponent": Generator(_rank_exponent, 1.0),
        "quantifier": Generator(_quantifier, 0.5),
        "centroid": Generator(_centroid, None),
    }
)
"""Name -> generator; that of ``geometric`` has the paper's table as its source, see above.

- ``geometric``: each weight is *parameter* times the one before (0: only the best score; 1: equal weights).
- ``rank-reciprocal``: ``1 / rank**parameter`` (Stillwell, Seaver, Edwards 1981: rank reciprocal).
- ``rank-exponent``: ``(n + 1 - rank)**parameter``; 1 is linear ranking (Stillwell, Seaver, Edwards, "A
  comparison of weight approximation techniques in multiattribute utility decision making", Organizational
  Behavior and Human Performance, 1981: rank exponent, rank sum).
- ``quantifier``: ``(rank/n)**parameter - ((rank-1)/n)**parameter`` (Yager 1988, section on quantifiers).
- ``centroid``: mean of ``1/k`` over the ranks k from its own on (Barron and Barrett, "Decision quality using
  ranked attribute weights", Management Science, 1996: rank-order centroid).
"""


def generated_weights(name: GeneratorName, n: int, parameter: float | None = None) -> tuple[float, ...]:
    """Return the weights of *n* sorted scores, the largest score first; non-negative, with the sum 1.

    Args:
        name: A generator.
        n: Number of scores, at least 1.
        parameter: Its parameter, >= 0; ``None``: the default.
    """
    generator = GENERATORS[name]
    value = generator.parameter if parameter is None else parameter
    shares = generator.shares(n, 0.0 if value is None else value)
    total = math.fsum(shares)
    return tuple(share / total for share in shares)


def require_weights(_: object, __: object, weights: tuple[float, ...] | GeneratorName | None) -> None:
    """Validate an option for weights: a generator's name, or non-negative numbers with the sum 1.

    Raises:
        ValueError: The name is unknown, a weight is negative, or the sum differs from 1.
    """
    if isinstance(weights, str):
        if weights not in GENERATORS:
            raise ValueError(f"expected weights or one of {', '.join(GENERATORS)}, found {weights}")
    elif weights is not None:
        _require_shares(weights)


def _require_shares(weights: tuple[float, ...]) -> None:
    if not weights:
        raise ValueError("expected at least one weight, found none")
    for weight in weights:
        if not weight >= 0:
            raise ValueError(f"expected non-negative weights, found {weight}")
    total = math.fsum(weights)
    if not abs(total - 1) <= 1e-12:
        raise ValueError(f"expected weights that sum to 1, found the sum {total:.15g}")
