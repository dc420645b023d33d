"""Plugins that a test creates."""

from __future__ import annotations

import types
from collections.abc import Callable
from typing import Any

from evoframe import hookimpl


def plugin(**functions: Callable[..., Any]) -> types.ModuleType:
    """Return a module whose *functions* implement the hooks of their names."""
    module = types.ModuleType("plugin")
    for name, function in functions.items():
        setattr(module, name, hookimpl(function))
    return module
