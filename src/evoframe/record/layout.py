"""Layout of a run's directory: its files, and the tables of its database."""

from __future__ import annotations

from collections.abc import Iterable

__all__ = [
    "CHAMPION_FILE",
    "CONFIG_FILE",
    "DATABASE_FILE",
    "RECORD_FILES",
    "RUN_FORMAT",
    "SETTLED",
    "VERIFICATION_FILE",
    "schema",
]

RUN_FORMAT = 3
"""Version of the format of a run's directory; champion.json has its own."""

CHAMPION_FILE = "champion.json"
CONFIG_FILE = "config.toml"
DATABASE_FILE = "run.db"

SETTLED = frozenset({"format", "configuration"})
"""Keys of ``meta`` that are written at the start; all others are the final figures of a finished run."""

VERIFICATION_FILE = "verification.json"
"""Verification of the champion."""

RECORD_FILES = (CONFIG_FILE, DATABASE_FILE, f"{DATABASE_FILE}-journal", CHAMPION_FILE, VERIFICATION_FILE)
"""The files that contain the data of a run."""

_SCHEMA = """
CREATE TABLE meta (key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE turns (
    turn INTEGER, population TEXT, generation INTEGER NOT NULL,
    best REAL NOT NULL, best_so_far REAL NOT NULL, standing_champion REAL NOT NULL, mean REAL NOT NULL,
    PRIMARY KEY (turn, population)
) WITHOUT ROWID;
CREATE TABLE individuals (
    turn INTEGER, population TEXT, position INTEGER, genome_id INTEGER NOT NULL, species INTEGER,
    genome_size INTEGER NOT NULL, age INTEGER NOT NULL, fitness REAL NOT NULL, diverged INTEGER NOT NULL,
    PRIMARY KEY (turn, population, position)
) WITHOUT ROWID;
CREATE TABLE measures (
    turn INTEGER, population TEXT, position INTEGER, name TEXT, value REAL NOT NULL,
    PRIMARY KEY (turn, population, position, name)
) WITHOUT ROWID;
CREATE TABLE pairs (
    turn INTEGER, pair INTEGER, {roles}, score REAL, diverged_at INTEGER,
    PRIMARY KEY (turn, pair)
) WITHOUT ROWID;
CREATE TABLE best_pairs (turn INTEGER PRIMARY KEY, score REAL NOT NULL, document TEXT NOT NULL);
CREATE TABLE state (part TEXT PRIMARY KEY, turn INTEGER NOT NULL, state TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE workload (
    turn INTEGER PRIMARY KEY, pairs INTEGER NOT NULL, simulations INTEGER NOT NULL, seconds REAL NOT NULL
);
CREATE TABLE resumes (number INTEGER PRIMARY KEY, after_turn INTEGER, differences TEXT NOT NULL);
CREATE TABLE checksums (name TEXT PRIMARY KEY, checksum TEXT NOT NULL) WITHOUT ROWID;
"""


def schema(roles: Iterable[str]) -> list[str]:
    """Return the statements that create the tables of a run's database."""
    columns = ", ".join(f'"{role}" INTEGER NOT NULL' for role in roles)
    return [statement.strip() for statement in _SCHEMA.format(roles=columns).split(";") if statement.strip()]
