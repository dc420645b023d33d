"""Designs that a person names: reading, verifying and exporting them."""

from evoframe.designs.exporting import exports
from evoframe.designs.sources import DEFAULT_PRESET, Job, naming, read_job
from evoframe.designs.verifying import keep_of_job, verified, verify, verify_job

__all__ = [
    "DEFAULT_PRESET",
    "Job",
    "exports",
    "keep_of_job",
    "naming",
    "read_job",
    "verified",
    "verify",
    "verify_job",
]
