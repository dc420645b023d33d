"""The 23 activation functions of the paper, for all points at once.

Each has the formula, the scale and the clamps of neat-python 2.0; the five that it lacks (``neg_abs``,
``neg_square``, ``sqrt_abs``, ``neg_sqrt_abs``, ``neg_sin``) are those of the authors' code. What enters and
leaves a node is clamped to +-:data:`LIMIT`, and a NaN becomes 0: no network can leave the finite numbers.

Arithmetic is numpy's, which rounds as Python does. Exponentials, logarithms, sines and powers come from the
C library through :mod:`math`, one number at a time, as neat-python's do: numpy's own differ from these in
their last bits, and a node such as ``inv`` turns a last bit into any error. The C library too may choose
other variants on another processor; on one machine a network is neat-python's network bit for bit.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from itertools import repeat
from types import MappingProxyType
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

__all__ = ["ACTIVATIONS", "LIMIT", "Activation", "guard"]

Values: TypeAlias = NDArray[np.float64]
Activation: TypeAlias = Callable[[Values], Values]

LIMIT = 1e50
"""Far beyond any value at which the formulas still mean something; replaces neat-python's OverflowError."""

_SELU_SCALE = 1.0507009873554804934193349852946
_SELU_ALPHA = 1.6732632423543772848170429916717


def guard(z: Values) -> Values:
    """Clamp *z* to +-:data:`LIMIT`, and make a NaN 0."""
    clamped = _clamp(z, LIMIT)
    return np.where(np.isnan(clamped), 0.0, clamped)


def _clamp(z: Values, limit: float) -> Values:
    return np.minimum(np.maximum(z, -limit), limit)


def _one_by_one(function: Callable[[float], float], z: Values) -> Values:
    return np.fromiter(map(function, z.ravel().tolist()), np.float64, z.size).reshape(z.shape)


def _exp(z: Values) -> Values:
    return _one_by_one(math.exp, z)


def _log(z: Values) -> Values:
    return _one_by_one(math.log, z)


def _sin(z: Values) -> Values:
    return _one_by_one(math.sin, z)


def _power(z: Values, exponent: float) -> Values:
    """Return the C library's power, which is not always the product that numpy makes of a square."""
    powers = map(math.pow, z.ravel().tolist(), repeat(exponent))
    return np.fromiter(powers, np.float64, z.size).reshape(z.shape)


def _sigmoid(z: Values) -> Values:
    return 1.0 / (1.0 + _exp(-_clamp(5.0 * z, 60.0)))


def _tanh(z: Values) -> Values:
    return _one_by_one(math.tanh, _clamp(2.5 * z, 60.0))


def _sin_5(z: Values) -> Values:
    return _sin(_clamp(5.0 * z, 60.0))


def _softplus(z: Values) -> Values:
    return 0.2 * _log(1.0 + _exp(_clamp(5.0 * z, 60.0)))


def _gauss(z: Values) -> Values:
    return _exp(-5.0 * _power(_clamp(z, 3.4), 2.0))


def _relu(z: Values) -> Values:
    return np.where(z > 0.0, z, 0.0)


def _exp_minus_one(z: Values) -> Values:
    """Return e^z - 1 as neat-python rounds it, at *z* <= 0 (what stands above is never chosen)."""
    return _exp(np.minimum(z, 0.0)) - 1.0


def _elu(z: Values) -> Values:
    return np.where(z > 0.0, z, _exp_minus_one(z))


def _lelu(z: Values) -> Values:
    return np.where(z > 0.0, z, 0.005 * z)


def _selu(z: Values) -> Values:
    return np.where(z > 0.0, _SELU_SCALE * z, _SELU_SCALE * _SELU_ALPHA * _exp_minus_one(z))


def _identity(z: Values) -> Values:
    return z


def _clamped(z: Values) -> Values:
    return _clamp(z, 1.0)


def _inv(z: Values) -> Values:
    with np.errstate(divide="ignore", over="ignore"):  # 1 / 0 is not chosen, 1 / 5e-324 is clamped
        return np.where(z == 0.0, 0.0, 1.0 / z)


def _log_above_zero(z: Values) -> Values:
    return _log(np.maximum(1e-7, z))


def _exp_clamped(z: Values) -> Values:
    return _exp(_clamp(z, 60.0))


def _abs(z: Values) -> Values:
    return np.abs(z)


def _hat(z: Values) -> Values:
    return np.maximum(0.0, 1.0 - np.abs(z))


def _square(z: Values) -> Values:
    return _power(z, 2.0)


def _cube(z: Values) -> Values:
    return _power(z, 3.0)


def _neg_abs(z: Values) -> Values:
    return -np.abs(z)


def _neg_square(z: Values) -> Values:
    return -_power(z, 2.0)


def _sqrt_abs(z: Values) -> Values:
    return np.sqrt(np.abs(z))


def _neg_sqrt_abs(z: Values) -> Values:
    return -np.sqrt(np.abs(z))


def _neg_sin(z: Values) -> Values:
    return -_sin(z)


def _guarded(formula: Activation) -> Activation:
    def activation(z: Values) -> Values:
        return guard(formula(guard(z)))

    return activation


_FORMULAS: Mapping[str, Activation] = {
    "sigmoid": _sigmoid,
    "tanh": _tanh,
    "sin": _sin_5,
    "softplus": _softplus,
    "gauss": _gauss,
    "relu": _relu,
    "elu": _elu,
    "lelu": _lelu,
    "selu": _selu,
    "identity": _identity,
    "clamped": _clamped,
    "inv": _inv,
    "log": _log_above_zero,
    "exp": _exp_clamped,
    "abs": _abs,
    "hat": _hat,
    "square": _square,
    "cube": _cube,
    "neg_abs": _neg_abs,
    "neg_square": _neg_square,
    "sqrt_abs": _sqrt_abs,
    "neg_sqrt_abs": _neg_sqrt_abs,
    "neg_sin": _neg_sin,
}

ACTIVATIONS: Mapping[str, Activation] = MappingProxyType(
    {name: _guarded(formula) for name, formula in _FORMULAS.items()}
)
"""Name -> guarded function of an array of any shape, in the order of the paper's table."""
