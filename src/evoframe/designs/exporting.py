"""Designs as files of other programs, in the formats of their simulator."""

from __future__ import annotations

import logging

from evoframe.contract.protocols import Simulator
from evoframe.contract.values import Design, Export
from evoframe.errors import EvoframeError

__all__ = ["export_design", "exports", "formats_of"]

_log = logging.getLogger(__name__)


def formats_of(simulator: Simulator) -> tuple[str, ...]:
    """Return the formats that *simulator* writes; none if it offers no export."""
    return tuple(getattr(simulator, "formats", ()))


def export_design(simulator: Simulator, design: Design, format_: str) -> Export:
    """Return *design* with the settings of *simulator*, in one of its formats."""
    export: Export = simulator.export(design, format_)  # type: ignore[attr-defined]
    return export


def exports(simulator: Simulator, design: Design) -> dict[str, bytes | None]:
    """Return *design* in every format of *simulator*.

    Returns:
        Ending -> bytes of the file. ``None`` where a format cannot say the design; the log says why.
    """
    return {format_: _exported(simulator, design, format_) for format_ in formats_of(simulator)}


def _exported(simulator: Simulator, design: Design, format_: str) -> bytes | None:
    try:
        export = export_design(simulator, design, format_)
    except Exception as error:  # noqa: BLE001 - the run does not depend on it
        cause = str(error) if isinstance(error, EvoframeError) else f"{type(error).__name__}: {error}"
        _log.warning("there is no %s file of the champion: %s", format_, cause)
        return None
    for entry in export.left_out:
        _log.info("the %s file of the champion leaves out: %s", format_, entry)
    return export.data
