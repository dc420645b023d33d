"""Whose fault it is: what goes wrong in a component is reported as the component's."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator

from evoframe.errors import ComponentError, EvoframeError

__all__ = ["blaming"]


@contextlib.contextmanager
def blaming(component: str, concerns: str = "") -> Iterator[None]:
    """Report whatever a component raises as its own.

    Errors of evoframe pass: they are meant to be read by a person, and say themselves whose they are.

    Args:
        component: Its dotted key in a configuration, such as ``populations.controller.evolver``.
        concerns: Which individual it was about.

    Raises:
        ComponentError: The component raised something.
    """
    try:
        yield
    except EvoframeError:
        raise
    except (Exception, SystemExit) as error:
        raise ComponentError(component, f"{type(error).__name__}: {error}", concerns) from error
