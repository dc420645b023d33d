"""Designs as files of other programs, in the formats of their simulator."""

from __future__ import annotations

import logging

from evoframe.contract import Design, Simulator, SupportsExport
from evoframe.messages import cause_of

__all__ = ["exports"]

_log = logging.getLogger(__name__)


def exports(simulator: Simulator, design: Design) -> dict[str, bytes | None]:
    """Return *design* in every format of *simulator*, if it has any.

    Returns:
        Ending -> bytes of the file. ``None`` where a format cannot say the design; the log says why.
    """
    if not isinstance(simulator, SupportsExport):
        return {}
    return {format_: _exported(simulator, design, format_) for format_ in simulator.formats}


def _exported(simulator: SupportsExport, design: Design, format_: str) -> bytes | None:
    try:
        export = simulator.export(design, format_)
    except Exception as error:  # noqa: BLE001 - the run does not depend on it
        _log.warning("there is no %s file of the champion: %s", format_, cause_of(error))
        return None
    for entry in export.left_out:
        _log.info("the %s file of the champion leaves out: %s", format_, entry)
    return export.data
