"""The simulator ``functions``: benchmark functions of cooperative coevolution, without physics.

:mod:`.formulas` defines the functions, :mod:`.simulator` evaluates them as simulations of one step.
"""

from evoframe_simulators.functions.formulas import (
    Booth,
    Function,
    Griewangk,
    MaximumOfQuadratics,
    OneRidge,
    Quadratic,
    Rastrigin,
    Rosenbrock,
)
from evoframe_simulators.functions.simulator import Functions

__all__ = [
    "Booth",
    "Function",
    "Functions",
    "Griewangk",
    "MaximumOfQuadratics",
    "OneRidge",
    "Quadratic",
    "Rastrigin",
    "Rosenbrock",
]
