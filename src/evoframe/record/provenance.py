"""Provenance of a run: versions, local plugins and machine, as information and a condition for resuming."""

from __future__ import annotations

import platform

import numpy as np

from evoframe._version import __version__
from evoframe.contract import RunConfig, SupportsProvenance
from evoframe.documents import Tree, differences
from evoframe.record.run import Run

__all__ = ["changed_provenance", "provenance_of"]

_LOCAL = "local_plugins"


def provenance_of(config: RunConfig) -> Tree:
    """Return the table ``[provenance]``: versions, machine type, and the source of each component.

    Local plugins have no version; their source has a checksum instead.
    """
    components = dict(config.components())
    libraries = {"python": platform.python_version(), "numpy": np.__version__}
    for chosen in components.values():
        if isinstance(chosen.component, SupportsProvenance):
            libraries |= chosen.component.provenance()
    sources = [chosen.source for key, chosen in components.items() if key != "executor"]
    local = {source.distribution: source.digest for source in sources if source.digest}
    vectors = np.show_config(mode="dicts").get("SIMD Extensions", {})
    return {
        "evoframe": __version__,
        "machine": platform.machine(),
        "vector_extensions": [*vectors.get("baseline", []), *vectors.get("found", [])],
        "c_library": " ".join(platform.libc_ver()),
        "libraries": libraries,
        "components": {key: str(chosen.source) for key, chosen in components.items()},
        **({_LOCAL: local} if local else {}),
    }


def changed_provenance(run: Run, config: RunConfig) -> list[str]:
    """Return a line for each difference between the provenance of a run and that of this process."""
    then, now = run.config.get("provenance", {}), provenance_of(config)
    if _LOCAL not in then:  # written before evoframe recorded it
        now.pop(_LOCAL, None)
    return differences(then, now)
