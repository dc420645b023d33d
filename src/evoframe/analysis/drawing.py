"""Matplotlib without its global state: the same figures whatever the environment and settings of the user.

This module is the first that imports matplotlib, which fails by itself if ``MPLBACKEND`` names a module that
is not installed, as in a program started from a notebook.
"""

from __future__ import annotations

import contextlib
import io
import os
import sys
from collections.abc import Iterator
from contextvars import ContextVar
from typing import Any

from evoframe.errors import InputError

__all__ = ["Figure", "default_style"]

_BACKEND = "MPLBACKEND"


def _load() -> None:
    """Import matplotlib; use the backend that the environment names if it is available.

    Raises:
        InputError: A file ``matplotlibrc`` cannot be read.
    """
    if "matplotlib" in sys.modules:
        return
    backend = os.environ.pop(_BACKEND, None)
    try:
        import matplotlib  # noqa: ICN001, PLC0415
    except (OSError, ValueError) as error:
        raise InputError(f"matplotlib cannot read its settings: {error}", source="matplotlibrc") from error
    finally:
        if backend is not None:
            os.environ[_BACKEND] = backend
    if backend is not None:
        with contextlib.suppress(ValueError):  # figures of evoframe need none
            matplotlib.rcParams["backend"] = backend


_load()

import matplotlib as mpl  # noqa: E402 - only now
from matplotlib import figure  # noqa: E402

_OF_WINDOWS = ("backend", "backend_fallback")
"""Settings that are not restored at the end of a context."""


_in_use: ContextVar[bool] = ContextVar("default style in use", default=False)


@contextlib.contextmanager
def default_style(**settings: Any) -> Iterator[None]:
    """Use matplotlib's defaults and some *settings* in the block; texts are literal, without formulas.

    Names of files may contain dollar signs, which must not start a formula. Inside another such block, only
    the *settings* change.
    """
    style: Any = settings
    if not _in_use.get():
        defaults = {key: value for key, value in mpl.rcParamsDefault.items() if key not in _OF_WINDOWS}
        style = {**defaults, "text.parse_math": False, **settings}
    token = _in_use.set(True)
    try:
        with mpl.rc_context(style):
            yield
    finally:
        _in_use.reset(token)


_OF_FORMATS = ("pdf.", "pgf.", "ps.", "svg.")


class Figure(figure.Figure):
    """A figure in matplotlib's default style, which notebooks display without pyplot."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        with default_style():
            super().__init__(*args, **kwargs)

    def draw(self, renderer: Any) -> None:
        """Draw the figure, including the parts that matplotlib adds only now, in the default style.

        Settings of file formats, such as ``pdf.fonttype``, remain those of the caller.
        """
        with default_style(**{key: mpl.rcParams[key] for key in mpl.rcParams if key.startswith(_OF_FORMATS)}):
            super().draw(renderer)

    def _repr_png_(self) -> bytes:
        """Return the image that IPython displays."""
        image = io.BytesIO()
        with default_style():
            self.savefig(image, format="png", dpi=150)
        return image.getvalue()
