"""Attribution of exceptions to the components that raise them."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator

from evoframe.errors import ComponentError, EvoframeError

__all__ = ["blaming"]


@contextlib.contextmanager
def blaming(component: str, concerns: str = "") -> Iterator[None]:
    """Wrap exceptions raised by a component in :class:`ComponentError`.

    Errors of evoframe are not wrapped: they already name their cause.

    Args:
        component: Dotted key of the component in the configuration, such as
            ``populations.controller.evolver``.
        concerns: Individual that the component was processing.

    Raises:
        ComponentError: The component raised an exception.
    """
    try:
        yield
    except EvoframeError:
        raise
    except (Exception, SystemExit) as error:
        raise ComponentError(component, f"{type(error).__name__}: {error}", concerns) from error
