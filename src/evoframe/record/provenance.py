"""Provenance of a run: versions and machine, for the reader and as a condition for resuming."""

from __future__ import annotations

import platform

import numpy as np

from evoframe._version import __version__
from evoframe.contract import RunConfig, SupportsProvenance
from evoframe.documents import Tree

__all__ = ["provenance_of"]


def provenance_of(config: RunConfig) -> Tree:
    """Return the table ``[provenance]``: versions, machine type, and the source of each component."""
    components = dict(config.components())
    libraries = {"python": platform.python_version(), "numpy": np.__version__}
    for chosen in components.values():
        if isinstance(chosen.component, SupportsProvenance):
            libraries |= chosen.component.provenance()
    vectors = np.show_config(mode="dicts").get("SIMD Extensions", {})
    return {
        "evoframe": __version__,
        "machine": platform.machine(),
        "vector_extensions": [*vectors.get("baseline", []), *vectors.get("found", [])],
        "c_library": " ".join(platform.libc_ver()),
        "libraries": libraries,
        "components": {key: str(chosen.source) for key, chosen in components.items()},
    }
