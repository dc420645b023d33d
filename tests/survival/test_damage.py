"""Damage of a database is detected, or does not change any value that is read."""

from __future__ import annotations

import random
import shutil
import sqlite3
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from opening import reopened
from recorded import rewritten

from evoframe import InputError, Run, discover, load_run, run
from evoframe.record.checksums import CHAINED, SINGLE
from evoframe.record.layout import RUN_FORMAT

TRIALS = 200
PAGE = 4096


def everything(directory: Path) -> list[Any]:
    """Return all that can be read from a run."""
    loaded = load_run(directory)
    tables = [loaded.table(name) for name in (*CHAINED, *SINGLE)]
    champion = loaded.champion()
    roles = {role: array.tolist() for role, array in champion.design.roles.items()}
    return [
        tables,
        loaded.summary(),
        loaded.state(),
        champion.score,
        champion.simulation,
        roles,
        loaded.verification(),
    ]


def flip_bytes(data: bytearray, chance: random.Random) -> None:
    for _ in range(chance.choice([1, 1, 1, 8, 64])):
        data[chance.randrange(len(data))] ^= 1 << chance.randrange(8)


def truncate(data: bytearray, chance: random.Random) -> None:
    del data[chance.randrange(len(data)) :]


def zero_a_page(data: bytearray, chance: random.Random) -> None:
    at = PAGE * chance.randrange(len(data) // PAGE)
    data[at : at + PAGE] = bytes(PAGE)


def swap_pages(data: bytearray, chance: random.Random) -> None:
    first, second = (PAGE * chance.randrange(len(data) // PAGE) for _ in range(2))
    data[first : first + PAGE], data[second : second + PAGE] = (
        data[second : second + PAGE],
        data[first : first + PAGE],
    )


DAMAGES: list[Callable[[bytearray, random.Random], None]] = [
    flip_bytes,
    flip_bytes,
    truncate,
    zero_a_page,
    swap_pages,
]


@pytest.fixture(scope="module")
def intact(tmp_path_factory: pytest.TempPathFactory) -> Run:
    return run("quick", out=tmp_path_factory.mktemp("intact") / "run")


def test_damage_is_detected_or_harmless(intact: Run, tmp_path: Path) -> None:
    expected = everything(intact.directory)
    original = (intact.directory / "run.db").read_bytes()
    chance = random.Random(5)  # noqa: S311
    detected = 0
    for trial in range(TRIALS):
        directory = tmp_path / str(trial)
        shutil.copytree(intact.directory, directory)
        data = bytearray(original)
        DAMAGES[trial % len(DAMAGES)](data, chance)
        (directory / "run.db").write_bytes(data)
        try:
            found = everything(directory)
        except InputError as error:
            detected += str(directory) in str(error)
        else:
            assert found == expected, trial
        shutil.rmtree(directory)
    assert detected > TRIALS // 2


@pytest.mark.parametrize(
    ("statement", "names"),
    [
        ("UPDATE pairs SET score = score * 2 WHERE turn = 3 AND pair = 1", "pairs"),
        ("DELETE FROM individuals WHERE turn = 4", "individuals"),
        ("UPDATE turns SET best = 1.0 WHERE turn = 1", "turns"),
        ("UPDATE best_pairs SET score = 1.0", "best_pairs"),
        ("UPDATE meta SET value = '1.0' WHERE key = 'best_pair_score'", "meta:best_pair_score"),
        ("DELETE FROM meta WHERE key = 'turns'", "meta:turns"),
        ("UPDATE state SET turn = 0 WHERE part = 'loop'", "state:loop"),
        ("DELETE FROM state WHERE part = 'population/controller'", "state:population/controller"),
        ("INSERT INTO workload VALUES (99, 1, 1, 1.0)", "workload"),
        ("DELETE FROM checksums WHERE name = 'pairs'", "pairs"),
    ],
)
def test_a_change_by_hand_is_named(intact: Run, tmp_path: Path, statement: str, names: str) -> None:
    shutil.copytree(intact.directory, tmp_path / "run")
    with sqlite3.connect(tmp_path / "run" / "run.db") as database:
        database.execute(statement)
    database.close()
    with pytest.raises(InputError, match="checksum") as caught:
        everything(tmp_path / "run")
    assert (caught.value.source, caught.value.key) == (str(tmp_path / "run" / "run.db"), names)


def reopen(directory: Path) -> None:
    reopened(directory, discover())


def test_a_damaged_run_is_not_resumed(intact: Run, tmp_path: Path) -> None:
    shutil.copytree(intact.directory, tmp_path / "run")
    with sqlite3.connect(tmp_path / "run" / "run.db") as database:
        database.execute("UPDATE pairs SET score = 1.0 WHERE turn = 3 AND pair = 1")
    database.close()
    with pytest.raises(InputError, match="checksum") as caught:
        reopen(tmp_path / "run")
    assert caught.value.key == "pairs"


def test_an_endless_table_is_not_read(intact: Run, tmp_path: Path) -> None:
    shutil.copytree(intact.directory, tmp_path / "run")
    endless = (
        "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) SELECT 'format' AS key, i AS value"
    )
    with sqlite3.connect(tmp_path / "run" / "run.db") as database:
        database.execute("ALTER TABLE meta RENAME TO hidden")
        database.execute(f"CREATE VIEW meta AS {endless} FROM n WHERE i < 0")
    database.close()
    for read in (everything, reopen):
        with pytest.raises(InputError, match=f"expected {RUN_FORMAT}, found none;") as caught:
            read(tmp_path / "run")
        assert caught.value.key == "meta.format"


def test_names_of_populations_are_not_executed_as_sql(intact: Run, tmp_path: Path) -> None:
    shutil.copytree(intact.directory, tmp_path / "run")
    path = tmp_path / "run" / "config.toml"
    path.write_text(path.read_text().replace("[populations.morphology", "[populations.'m\" INTEGER, \"x'"))
    with pytest.raises(InputError, match=r"config\.toml") as caught:
        everything(tmp_path / "run")
    assert (caught.value.source, caught.value.key) == (str(tmp_path / "run" / "run.db"), "")


def test_values_of_wrong_types_are_refused(intact: Run, tmp_path: Path) -> None:
    shutil.copytree(intact.directory, tmp_path / "run")
    rewritten(tmp_path / "run", "UPDATE pairs SET score = 'high' WHERE turn = 1")
    with pytest.raises(InputError, match=r"types: .*'high'") as caught:
        everything(tmp_path / "run")
    assert caught.value.key == "pairs"


@pytest.mark.parametrize("schema", ["VIEW", "TRIGGER"])
def test_nothing_in_a_database_is_executed(intact: Run, tmp_path: Path, schema: str) -> None:
    shutil.copytree(intact.directory, tmp_path / "run")
    with sqlite3.connect(tmp_path / "run" / "run.db") as database:
        if schema == "VIEW":
            database.execute("ALTER TABLE pairs RENAME TO hidden")
            database.execute("CREATE VIEW pairs AS SELECT * FROM hidden")
        else:
            database.execute("CREATE TRIGGER t AFTER INSERT ON resumes BEGIN DELETE FROM pairs; END")
    database.close()
    for read in (everything, reopen):
        with pytest.raises(InputError, match=r"config\.toml") as caught:
            read(tmp_path / "run")
        assert (caught.value.source, caught.value.key) == (str(tmp_path / "run" / "run.db"), "")


def test_a_text_of_excessive_length_is_not_read(intact: Run, tmp_path: Path) -> None:
    shutil.copytree(intact.directory, tmp_path / "run")
    with sqlite3.connect(tmp_path / "run" / "run.db") as database:
        database.execute("UPDATE state SET state = zeroblob(100000000) WHERE part = 'loop'")
    database.close()
    with pytest.raises(InputError, match=r"run\.db: .*too big"):
        everything(tmp_path / "run")
