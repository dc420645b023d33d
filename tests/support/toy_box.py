"""The toy components as an installed plugin."""

from __future__ import annotations

import toys

from evoframe.contract.config import Source
from evoframe.registry.registry import Plugins


def installed() -> Plugins:
    plugins = Plugins()
    plugins.add(toys, Source("toy-box", "1.0", "toys"))
    return plugins
