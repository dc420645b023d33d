"""Robustness of bodies: their scores with the same random controllers."""

from evoframe.robustness.api import first_simulation, measurable, measure, measure_robustness, setting_of
from evoframe.robustness.candidates import Candidates, read_candidates
from evoframe.robustness.files import (
    SETTING_FILE,
    document_of,
    read_robustness,
    refuse_another,
    write_measurement,
)
from evoframe.robustness.measurement import Body, Divergence, Robustness, Setting

__all__ = [
    "SETTING_FILE",
    "Body",
    "Candidates",
    "Divergence",
    "Robustness",
    "Setting",
    "document_of",
    "first_simulation",
    "measurable",
    "measure",
    "measure_robustness",
    "read_candidates",
    "read_robustness",
    "refuse_another",
    "setting_of",
    "write_measurement",
]
