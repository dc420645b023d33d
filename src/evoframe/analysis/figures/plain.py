"""Texts of figures as they are: names come from files and folders, and a dollar sign begins no formula."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import ParamSpec

import matplotlib as mpl
from matplotlib.figure import Figure

__all__ = ["plain"]

P = ParamSpec("P")


def plain(draw: Callable[P, Figure]) -> Callable[P, Figure]:
    """Let a function that draws a figure take all texts as they are."""

    @wraps(draw)
    def drawn(*args: P.args, **kwargs: P.kwargs) -> Figure:
        with mpl.rc_context({"text.parse_math": False}):
            return draw(*args, **kwargs)

    return drawn
