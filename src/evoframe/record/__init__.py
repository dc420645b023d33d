"""The record of a run: a directory that is written during the run, and read back from it."""

from evoframe.record.champion import Champion, design_from_json, read_champion
from evoframe.record.checksums import CHAINED, SINGLE
from evoframe.record.layout import CHAMPION_FILE, CONFIG_FILE, RECORD_FILES
from evoframe.record.provenance import (
    bit_generations_of,
    changed_generations,
    changed_provenance,
    changed_scoring,
    provenance_of,
    recorded_generations,
)
from evoframe.record.run import Report, Run, load_run, open_run, open_unchecked
from evoframe.record.store import Store
from evoframe.record.verification import (
    UNCHANGED,
    WITHIN_REACH,
    Finding,
    Verification,
    keep_verification,
)

__all__ = [
    "CHAINED",
    "CHAMPION_FILE",
    "CONFIG_FILE",
    "RECORD_FILES",
    "SINGLE",
    "UNCHANGED",
    "WITHIN_REACH",
    "Champion",
    "Finding",
    "Report",
    "Run",
    "Store",
    "Verification",
    "bit_generations_of",
    "changed_generations",
    "changed_provenance",
    "changed_scoring",
    "design_from_json",
    "keep_verification",
    "load_run",
    "open_run",
    "open_unchecked",
    "provenance_of",
    "read_champion",
    "recorded_generations",
]
