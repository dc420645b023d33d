"""Designs as files of other programs, in the formats of their simulator."""

from __future__ import annotations

import logging

from evoframe.contract import Design, Export, Simulator, SupportsExport
from evoframe.designs.sources import Job, naming
from evoframe.errors import ConfigurationError, InputError
from evoframe.messages import cause_of, suggestion

__all__ = ["export_all", "export_job"]

_log = logging.getLogger(__name__)


def export_job(job: Job, format_: str) -> Export:
    """Return the only design of a job with its settings, in one of the formats of its simulator.

    Raises:
        ConfigurationError: The simulator writes no such files, or the format cannot express the settings.
        InputError: The job has several designs, or the format cannot express the design.
    """
    if len(job.designs) != 1:
        raise InputError(f"{job.path}: holds {len(job.designs)} designs, but a file is written of one")
    name, simulator = job.config.simulator.name, job.config.simulator.component
    if not isinstance(simulator, SupportsExport):
        raise ConfigurationError(f"the simulator '{name}' writes no files of other programs")
    if format_ not in simulator.formats:
        hint = suggestion(format_, simulator.formats, "formats")
        raise ConfigurationError(f"the simulator '{name}' has no format '{format_}'{hint}")
    with naming(job.path):
        return simulator.export(job.designs[0], format_)


def export_all(simulator: Simulator, design: Design) -> dict[str, bytes | None]:
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
