"""Export of designs to files of other programs, in the formats of their simulator."""

from __future__ import annotations

import logging

from evoframe.contract import Design, Export, Simulator, SupportsExport
from evoframe.designs.sources import Job, naming
from evoframe.errors import ConfigurationError, InputError
from evoframe.messages import cause_of, suggestion

__all__ = ["export_all", "export_job"]

_log = logging.getLogger(__name__)


def export_job(job: Job, format_: str) -> Export:
    """Export the single design of a job with its settings, in one of the formats of its simulator.

    Raises:
        ConfigurationError: The simulator lacks this format, or the format cannot represent the settings.
        InputError: The job has several designs, or the format cannot represent the design.
    """
    if len(job.designs) != 1:
        raise InputError(f"expected one design to export, found {len(job.designs)}", source=job.path)
    name, simulator = job.config.simulator.name, job.config.simulator.component
    if not isinstance(simulator, SupportsExport):
        raise ConfigurationError(f"'{name}' cannot export designs", source=job.path, key="simulator")
    if format_ not in simulator.formats:
        hint = suggestion(format_, simulator.formats, "formats")
        raise ConfigurationError(
            f"'{name}' has no format '{format_}'{hint}", source=job.path, key="simulator"
        )
    with naming(job.path):
        return simulator.export(job.designs[0], format_)


def export_all(simulator: Simulator, design: Design) -> dict[str, bytes | None]:
    """Export *design* in every format of *simulator*.

    Returns:
        Suffix -> bytes of the file; ``None`` if a format cannot represent the design (the log has the cause).
    """
    if not isinstance(simulator, SupportsExport):
        return {}
    return {format_: _export(simulator, design, format_) for format_ in simulator.formats}


def _export(simulator: SupportsExport, design: Design, format_: str) -> bytes | None:
    try:
        export = simulator.export(design, format_)
    except Exception as error:  # noqa: BLE001 - the run does not depend on it
        _log.warning("the champion cannot be exported as %s: %s", format_, cause_of(error))
        return None
    for entry in export.left_out:
        _log.info("the %s file of the champion omits: %s", format_, entry)
    return export.data
