"""Benchmark functions of several variables, as maximization problems; those to be minimized are negated.

They are computed with Python's floats, one point at a time, so that a value does not depend on a batch.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from typing import Any, ClassVar, Protocol, TypeAlias

import attrs
from attrs import validators

__all__ = [
    "Booth",
    "Function",
    "Griewangk",
    "MaximumOfQuadratics",
    "OneRidge",
    "Quadratic",
    "Rastrigin",
    "Rosenbrock",
]

Domain: TypeAlias = tuple[float, float]

_LARGEST = 1e9  # of a parameter, so that every value is finite


class Function(Protocol):
    """A function of several variables, to be maximized, which is finite in its domain."""

    @property
    def domain(self) -> Domain:
        """Smallest and largest value of each variable."""

    def check(self, variables: int) -> None:
        """Refuse a number of variables that the function does not have.

        Raises:
            ValueError: The message names both numbers.
        """

    def value(self, point: Sequence[float]) -> float:
        """Return the value at *point*, one number for each variable."""


def _is_domain(_instance: Any, attribute: attrs.Attribute[Any], domain: Domain) -> None:
    low, high = domain
    if not -_LARGEST <= low < high <= _LARGEST:
        raise ValueError(
            f"'{attribute.name}' must be two ascending numbers within +-{_LARGEST:g}: {list(domain)}"
        )


_bounded = validators.and_(validators.ge(-_LARGEST), validators.le(_LARGEST))


def _refuse_unless(accepted: bool, expected: str, variables: int) -> None:
    if not accepted:
        raise ValueError(
            f"expected {expected}, found {variables} (the number of simulator.roles times "
            "simulator.dimension)"
        )


@attrs.frozen(kw_only=True)
class Quadratic:
    """One peak of :class:`MaximumOfQuadratics`: ``height * (1 - 16 * |point - place|^2 / spread)``.

    It falls to 0 at the distance ``sqrt(spread) / 4`` from its place, and below 0 beyond it.

    Attributes:
        height: Value at *place* (H in the paper).
        place: Position of the peak, one number for each variable (X and Y in the paper).
        spread: Squared width of the peak (S in the paper).
    """

    height: float = attrs.field(validator=_bounded)
    place: tuple[float, ...] = attrs.field(validator=validators.deep_iterable(_bounded))
    spread: float = attrs.field(validator=[_bounded, validators.ge(1.0 / _LARGEST)])

    def value(self, point: Sequence[float]) -> float:
        """Return the value at *point*."""
        square = math.fsum((x - at) * (x - at) for x, at in zip(point, self.place, strict=True))
        return self.height * (1.0 - 16.0 * square / self.spread)


_BROAD = Quadratic(height=50.0, place=(0.75, 0.75), spread=1.6)
_NARROW = Quadratic(height=150.0, place=(0.25, 0.25), spread=1.0 / 32.0)


@attrs.frozen
class MaximumOfQuadratics:
    """Maximum of two quadratics (MTQ): a broad low peak, and a narrow high one that is easily missed.

    The function is ``max(H1 (1 - 16 (x - X1)^2 / S1 - 16 (y - Y1)^2 / S1), H2 (...))`` (L. Bull 2001, On
    coevolutionary genetic algorithms, Soft Computing 5), with the values of L. Panait, S. Luke and R. P.
    Wiegand 2006, Biasing coevolutionary search for optimal multiagent behaviors, IEEE Transactions on
    Evolutionary Computation 10: H1 = 50 at (3/4, 3/4), S1 = 1.6; H2 = 150 at (1/4, 1/4), S2 = 1/32. There the
    optimum has the value 150, and the local optimum 50. Any number of peaks and variables is possible.

    Attributes:
        peaks: The quadratics, at least one, in the unit square.
    """

    domain: ClassVar[Domain] = (0.0, 1.0)

    peaks: tuple[Quadratic, ...] = attrs.field(default=(_BROAD, _NARROW), validator=validators.min_len(1))

    def check(self, variables: int) -> None:
        """Require one number for each variable in the place of every peak."""
        for peak in self.peaks:
            n = len(peak.place)
            _refuse_unless(
                variables == n, f"{n} variables (the numbers in a place of simulator.mtq.peaks)", variables
            )

    def value(self, point: Sequence[float]) -> float:
        """Return the largest value of a quadratic."""
        return max(peak.value(point) for peak in self.peaks)


@attrs.frozen
class OneRidge:
    """A ridge along the diagonal, ``1 + 2 min(x, y) - max(x, y)``, which rises to 2 at (1, 1).

    Changing one variable alone leads only back to the ridge, where each variable is the best response to the
    other (E. Popovici and K. De Jong 2005, Understanding cooperative co-evolutionary dynamics via simple
    fitness landscapes, GECCO; L. Panait, S. Luke and J. F. Harrison 2006, Archive-based cooperative
    coevolutionary algorithms, GECCO). With more variables, the minimum and the maximum are those of all.
    """

    domain: ClassVar[Domain] = (0.0, 1.0)

    def check(self, variables: int) -> None:
        """Require at least two variables."""
        _refuse_unless(variables >= 2, "at least 2 variables", variables)

    def value(self, point: Sequence[float]) -> float:
        """Return the value at *point*."""
        return 1.0 + 2.0 * min(point) - max(point)


@attrs.frozen
class Griewangk:
    """Negated Griewangk function, ``prod(cos(x_i / sqrt(i))) - 1 - sum(x_i^2) / 4000``; i counts from 1.

    The optimum is 0 at the origin (A. O. Griewank 1981, Generalized descent for global optimization, Journal
    of Optimization Theory and Applications 34). M. A. Potter and K. A. De Jong 1994, A cooperative
    coevolutionary approach to function optimization, PPSN III, use the domain +-600; two variables within
    +-5.12 are common in later work on cooperative coevolution.

    Attributes:
        domain: Smallest and largest value of each variable.
    """

    domain: Domain = attrs.field(default=(-5.12, 5.12), validator=_is_domain)

    def check(self, variables: int) -> None:
        """Require at least one variable."""
        _refuse_unless(variables >= 1, "at least 1 variable", variables)

    def value(self, point: Sequence[float]) -> float:
        """Return the value at *point*."""
        waves = math.prod(math.cos(x / math.sqrt(i)) for i, x in enumerate(point, start=1))
        return waves - 1.0 - math.fsum(x * x for x in point) / 4000.0


@attrs.frozen
class Booth:
    """Negated Booth function, ``-(x + 2 y - 7)^2 - (2 x + y - 5)^2``: a diagonal valley, turned upside down.

    The optimum is 0 at (1, 3). The usual domain is +-10; works on cooperative coevolution use +-5.12.

    Attributes:
        domain: Smallest and largest value of each variable.
    """

    domain: Domain = attrs.field(default=(-5.12, 5.12), validator=_is_domain)

    def check(self, variables: int) -> None:
        """Require two variables."""
        _refuse_unless(variables == 2, "2 variables", variables)

    def value(self, point: Sequence[float]) -> float:
        """Return the value at *point*."""
        x, y = point
        one, other = x + 2.0 * y - 7.0, 2.0 * x + y - 5.0
        return -(one * one + other * other)


@attrs.frozen
class Rosenbrock:
    """Negated Rosenbrock function, ``-sum(100 (x_(i+1) - x_i^2)^2 + (1 - x_i)^2)``: a bent, flat ridge.

    The optimum is 0 where all variables are 1. With two variables, it is one of the functions of M. A. Potter
    and K. A. De Jong 1994, A cooperative coevolutionary approach to function optimization, PPSN III, on which
    a single best collaborator fails, because the variables interact.

    Attributes:
        domain: Smallest and largest value of each variable.
    """

    domain: Domain = attrs.field(default=(-2.048, 2.048), validator=_is_domain)

    def check(self, variables: int) -> None:
        """Require at least two variables."""
        _refuse_unless(variables >= 2, "at least 2 variables", variables)

    def value(self, point: Sequence[float]) -> float:
        """Return the value at *point*."""
        return -math.fsum(
            100.0 * (after - x * x) * (after - x * x) + (1.0 - x) * (1.0 - x)
            for x, after in itertools.pairwise(point)
        )


@attrs.frozen
class Rastrigin:
    """Negated Rastrigin function, ``-sum(A + x_i^2 - A cos(2 pi x_i))``: separable, with many local optima.

    The optimum is 0 at the origin. The amplitude 3 is that of M. A. Potter and K. A. De Jong 1994, A
    cooperative coevolutionary approach to function optimization, PPSN III; elsewhere it is 10.

    Attributes:
        domain: Smallest and largest value of each variable.
        amplitude: Height A of the waves; without them, the function is a sphere.
    """

    domain: Domain = attrs.field(default=(-5.12, 5.12), validator=_is_domain)
    amplitude: float = attrs.field(default=3.0, validator=[_bounded, validators.ge(0.0)])

    def check(self, variables: int) -> None:
        """Require at least one variable."""
        _refuse_unless(variables >= 1, "at least 1 variable", variables)

    def value(self, point: Sequence[float]) -> float:
        """Return the value at *point*."""
        return -math.fsum(self.amplitude * (1.0 - math.cos(math.tau * x)) + x * x for x in point)
