"""Designs given by the user: reading, simulating, verifying and exporting."""

from evoframe.designs.exporting import export_all, export_job
from evoframe.designs.simulating import Overlooked, overlooked, simulate_job, trace_of
from evoframe.designs.sources import DEFAULT_PRESET, Job, naming, read_job
from evoframe.designs.verdicts import verdict
from evoframe.designs.verifying import keep_of_job, verify, verify_designs, verify_job

__all__ = [
    "DEFAULT_PRESET",
    "Job",
    "Overlooked",
    "export_all",
    "export_job",
    "keep_of_job",
    "naming",
    "overlooked",
    "read_job",
    "simulate_job",
    "trace_of",
    "verdict",
    "verify",
    "verify_designs",
    "verify_job",
]
