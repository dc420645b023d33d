"""Published bodies, which ``evoframe robustness --published`` adds to a comparison.

``published_sams.json`` next to this module contains the soft actuator morphologies of Alcaraz-Herrera et al.
(arXiv 2408.09107), from their repository biomeld-catheter-controller, licensed under Apache-2.0. Each body is
a list of layers in order of increasing z; within a layer x runs fastest, then y.
"""

from __future__ import annotations

import functools
import json
from importlib.resources import files

import numpy as np
from numpy.typing import NDArray

__all__ = ["published_bodies"]


@functools.cache
def published_bodies() -> dict[str, NDArray[np.uint8]]:
    """Return label -> material, ``uint8[20, 8, 8]`` with the codes of the paper, for each published body."""
    text = files("evoframe_simulators.vox").joinpath("published_sams.json").read_text(encoding="utf-8")
    document = json.loads(text)
    x, y, z = document["canvas"]
    bodies = {}
    for label, layers in document["sams"].items():
        codes = np.array([int(code) for layer in layers for code in layer], dtype=np.uint8)
        bodies[label] = np.ascontiguousarray(codes.reshape(z, y, x).T)
    return bodies
