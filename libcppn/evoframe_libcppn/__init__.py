"""Pattern-producing networks, compiled once and then called with arrays of points.

The implementation is the C library in ``libcppn/``. It checks its arguments, releases the GIL during
computation, and keeps no state, so that threads can share a network. ``libcppn/include/cppn.h`` defines its
values to the last bit.
"""

from collections.abc import Iterable, Mapping, Sequence
from typing import Final, Protocol, TypeAlias

import numpy as np
from numpy.typing import NDArray

from evoframe_libcppn._cppn import ffi, lib

__all__ = ["ACTIVATIONS", "VERSION", "CppnNetwork", "Link", "Node"]

VERSION: Final[str] = ffi.string(lib.cppn_version()).decode()
"""Version of the library; the second number increases with every change of the interface or of a bit of the
results."""

ACTIVATIONS: Final[tuple[str, ...]] = tuple(
    name.removeprefix("CPPN_").lower()
    for _, name in sorted(ffi.typeof("enum cppn_activation").elements.items())
)
"""Names of the activation functions, in the order of the paper's table."""

Link: TypeAlias = tuple[int, int, float]
"""A connection: from, to, weight."""

_CODES: Final = {name: code for code, name in enumerate(ACTIVATIONS)}
_UNKNOWN: Final = -1
_NODES: Final = ffi.typeof("struct cppn_node[]")
_LINKS: Final = ffi.typeof("struct cppn_link[]")
_NUMBERS: Final = ffi.typeof("double[]")


class Node(Protocol):
    """A node: activation(bias + response * sum of the weighted inputs)."""

    @property
    def activation(self) -> str:
        """One of :data:`ACTIVATIONS`."""

    @property
    def bias(self) -> float:
        """Number that is added to the scaled sum."""

    @property
    def response(self) -> float:
        """Factor of the sum."""


class CppnNetwork:
    """A feed-forward network: ``float64[n, inputs] -> float64[n, outputs]``, finite for any input.

    Inputs have the ids -1, -2, ... and outputs 0, 1, ..., as in neat-python. Nodes that no output depends on
    are omitted, and nodes that do not depend on inputs are computed only once.

    Args:
        inputs: Number of inputs.
        outputs: Number of outputs.
        nodes: Id -> node, outputs included.
        links: Connections, in the order in which nodes sum their inputs.

    Raises:
        ValueError: An output or an end of a link is missing, an activation is unknown, the network has a
            cycle, or a number is out of range.
        MemoryError: Memory is insufficient.
    """

    __slots__ = ("_handle", "inputs", "outputs")

    def __init__(self, inputs: int, outputs: int, nodes: Mapping[int, Node], links: Iterable[Link]) -> None:
        self.inputs: Final = inputs
        self.outputs: Final = outputs
        arcs = list(links)
        pointer, culprit = ffi.new("cppn_network **"), ffi.new("int64_t *")
        try:
            rows = [(k, _CODES.get(g.activation, _UNKNOWN), g.bias, g.response) for k, g in nodes.items()]
            status = lib.cppn_compile(
                inputs,
                outputs,
                len(rows),
                ffi.new(_NODES, rows),
                len(arcs),
                ffi.new(_LINKS, arcs),
                pointer,
                culprit,
            )
        except OverflowError as error:
            raise ValueError("an id or a number of the network exceeds 64 bits") from error
        if status != lib.CPPN_OK:
            raise _error(status, _detail(status, culprit[0], nodes, arcs))
        self._handle = ffi.gc(pointer[0], lib.cppn_destroy)

    @property
    def evaluated_nodes(self) -> int:
        """Number of nodes that are evaluated at each point."""
        count: int = lib.cppn_evaluated_nodes(self._handle)
        return count

    def __call__(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the outputs at each of *points*."""
        if points.ndim != 2 or points.shape[1] != self.inputs:
            raise ValueError(f"expected points of shape (n, {self.inputs}), got {points.shape}")
        given = np.ascontiguousarray(points, dtype=np.float64)
        if not given.flags.aligned:
            given = given.copy()
        values = np.empty((len(given), self.outputs))
        status = lib.cppn_evaluate(
            self._handle, len(given), ffi.from_buffer(_NUMBERS, given), ffi.from_buffer(_NUMBERS, values)
        )
        if status != lib.CPPN_OK:
            raise _error(status, "")
        return values


def _detail(status: int, culprit: int, nodes: Mapping[int, Node], links: Sequence[Link]) -> str:
    """Return the detail of an error that its status does not contain."""
    if status == lib.CPPN_UNKNOWN_END:
        source, target, _ = links[culprit]
        return f": {source} -> {target}"
    if status == lib.CPPN_MISSING_OUTPUT:
        return f": {culprit}"
    if culprit < 0:
        return ""
    node, gene = list(nodes.items())[culprit]
    return f" {gene.activation!r}: node {node}" if status == lib.CPPN_UNKNOWN_ACTIVATION else f": node {node}"


def _error(status: int, detail: str) -> Exception:
    """Return the exception for a status."""
    message = ffi.string(lib.cppn_status_message(status)).decode() + detail
    return MemoryError(message) if status == lib.CPPN_NO_MEMORY else ValueError(message)
