"""Figures in matplotlib's default style, with literal texts."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import ParamSpec

from evoframe.analysis.drawing import Figure, default_style

__all__ = ["plain"]

P = ParamSpec("P")


def plain(draw: Callable[P, Figure]) -> Callable[P, Figure]:
    """Decorate a function that draws a figure, so that settings of the user do not change it."""

    @wraps(draw)
    def drawn(*args: P.args, **kwargs: P.kwargs) -> Figure:
        with default_style():
            return draw(*args, **kwargs)

    return drawn
