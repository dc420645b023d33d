"""Roles that no population evolves: ``uniform``, ``file``, ``published``, ``champion``, ``random``."""

from __future__ import annotations

from collections.abc import Mapping

from evoframe import RoleProvider, hookimpl
from evoframe_roles.drawn import RandomController
from evoframe_roles.fixed import Champion, File, Published
from evoframe_roles.uniform import Uniform

__all__ = ["Champion", "File", "Published", "RandomController", "Uniform", "evoframe_roles"]


@hookimpl
def evoframe_roles() -> Mapping[str, type[RoleProvider]]:
    """Register the providers of this package."""
    return {
        "champion": Champion,
        "file": File,
        "published": Published,
        "random": RandomController,
        "uniform": Uniform,
    }
