"""Attribution of exceptions to the components that raise them."""

from __future__ import annotations

from evoframe.errors import ComponentError, EvoframeError

__all__ = ["blaming"]


class blaming:  # noqa: N801 - used as a statement, like contextlib.suppress
    """Wrap exceptions raised by a component in :class:`ComponentError`; a context manager.

    Errors of evoframe are not wrapped: they already name their cause.

    Args:
        component: Dotted key of the component in the configuration, such as
            ``populations.controller.evolver``.
        concerns: Individual that the component was processing.

    Raises:
        ComponentError: The component raised an exception.
    """

    __slots__ = ("_component", "_concerns")

    def __init__(self, component: str, concerns: str = "") -> None:
        self._component = component
        self._concerns = concerns

    def __enter__(self) -> None: ...

    def __exit__(self, _type: object, error: BaseException | None, _traceback: object) -> None:
        if isinstance(error, (Exception, SystemExit)) and not isinstance(error, EvoframeError):
            problem = f"{type(error).__name__}: {error}"
            raise ComponentError(self._component, problem, self._concerns) from error
