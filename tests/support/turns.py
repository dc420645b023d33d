"""Generated turns and stores, for tests that save and read them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import tomli_w
from hypothesis import strategies as st

from evoframe import BestPair, Design, Member, Pair, PopulationReport, Turn, Workload
from evoframe.files.locks import acquire_lock
from evoframe.record.store import Exports, Store

__all__ = ["CONFIG", "ROLES", "begun", "best_pairs", "reopened", "states", "turns"]

ROLES = ("a", "b")
CONFIG: dict[str, Any] = {"extends": False, "run": {"seed": 3}, "populations": {role: {} for role in ROLES}}
SIMULATION = {"simulator": {"name": "toy-product"}, "objective": {"name": "toy-value"}}

_numbers = st.floats(allow_nan=False, allow_infinity=False)
_integers = st.integers(-(2**63), 2**63 - 1)
_counts = st.integers(0, 2**31)

members = st.builds(
    Member,
    id=_integers,
    fitness=_numbers,
    species=st.none() | _counts,
    genome_size=_counts,
    age=_counts,
    diverged=st.booleans(),
)
pairs = st.builds(Pair, genomes=st.tuples(_integers, _integers), score=st.none() | _numbers)
states = st.dictionaries(
    st.sampled_from(["loop", "population/a", "population/b"]),
    st.dictionaries(st.text(max_size=3), _numbers | st.text(max_size=3), max_size=2),
    min_size=1,
)


def _reports(population: str) -> st.SearchStrategy[PopulationReport]:
    return st.builds(
        PopulationReport,
        population=st.just(population),
        generation=_counts,
        members=st.lists(members, min_size=1, max_size=3).map(tuple),
        best=_numbers,
        best_so_far=_numbers,
        standing_champion=_numbers,
        mean=_numbers,
    )


@st.composite
def best_pairs(draw: st.DrawFn, turn: int = 0) -> BestPair:
    """Return a best pair with a design of arbitrary numbers."""
    values = draw(st.lists(_numbers, min_size=1, max_size=3))
    genomes = draw(st.dictionaries(st.sampled_from(ROLES), st.lists(_numbers, max_size=2)))
    return BestPair(turn, draw(_numbers), {"a": 1, "b": 2}, genomes, Design({"a": np.array(values)}))


@st.composite
def turns(draw: st.DrawFn, most: int = 4) -> list[Turn]:
    """Return consecutive turns with arbitrary contents."""
    return [
        Turn(
            index=index,
            reports=tuple(draw(_reports(role)) for role in (ROLES if index == 0 else ROLES[index % 2 :][:1])),
            pairs=tuple(draw(st.lists(pairs, max_size=3))),
            best_pair=draw(st.none() | best_pairs(index)),
            workload=draw(st.builds(Workload, _counts, _counts, st.floats(0, 0.1))),
        )
        for index in range(draw(st.integers(0, most)))
    ]


def begun(directory: Path, exports: Exports = lambda _: {}) -> Store:
    """Create a directory and return the store of a new run in it."""
    directory.mkdir(parents=True)
    (directory / "config.toml").write_text(tomli_w.dumps(CONFIG))
    store = Store.open(directory, SIMULATION, acquire_lock(directory), exports)
    store.begin(ROLES, CONFIG)
    return store


def reopened(directory: Path) -> Store:
    """Return the store of an existing run."""
    return Store.open(directory, SIMULATION, acquire_lock(directory))
