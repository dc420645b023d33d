"""Kill runs at random moments, resume them, and compare the results with uninterrupted runs.

``python tests/survival/kills.py --kills 500`` is the long form; the suite kills 50 times. A kill counts only
if a turn was saved since the last start of the run. Half of the kills come from outside at any moment, the
others from inside: between two statements of a transaction, or before or after writing a champion's file.
The configurations take turns: the preset ``quick``, and toy ones with memories, timings and roles.

Every attempt is a fork of this process, which avoids starting Python again.
"""

from __future__ import annotations

import argparse
import collections
import contextlib
import os
import random
import signal
import sqlite3
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import evoframe.record.store
from evoframe import Plugins, RunConfig, Turn, hookimpl, load_config, load_run
from evoframe.registry.discovery import discover
from evoframe.runs.starting import prepare

sys.path.insert(0, str(Path(__file__).parent.parent / "support"))
import toy_box
from opening import has_begun, is_finished, reopened
from recorded import assert_same_result, rows

GENERATIONS = {
    "quick": 20,
    "parallel archive": 40,
    "three archive": 12,
    "asynchronous archive": 16,
    "own strategies": 20,
    "one with a role for each": 40,
}
"""The preset and the toy configurations that are killed, and their generations."""

_PAUSE = 0.02  # s; longest time between a saved turn and a kill from outside, longer than a turn


class Reporter:
    """Reports every saved turn to the parent process."""

    def __init__(self, pipe: int) -> None:
        self.pipe = pipe

    @hookimpl
    def evoframe_turn_finished(self, turn: Turn) -> None:
        del turn
        os.write(self.pipe, b".")


def play(directory: Path, seed: int, workers: int, pipe: int) -> None:
    """Start or resume a run, and play it to the end."""
    plugins = discover()
    toy_box.add_to(plugins)
    plugins.manager.register(Reporter(pipe))
    if (directory / "config.toml").exists():
        execution = reopened(directory, plugins)
    else:
        execution = prepare(configuration(seed, workers, plugins), plugins, directory)
    execution.play()


def kind_of(seed: int) -> str:
    """Return the name of the configuration of the run with this *seed*."""
    return list(GENERATIONS)[seed % len(GENERATIONS)]


def configuration(seed: int, workers: int, plugins: Plugins) -> RunConfig:
    """Return the configuration of the run with this *seed*."""
    kind = kind_of(seed)
    overrides = [
        f"run.seed={seed}",
        f"run.generations={GENERATIONS[kind]}",
        f"executor={{name='threads', workers={workers}}}",
    ]
    if kind == "quick":
        return load_config("quick", overrides=overrides, plugins=plugins)
    with tempfile.TemporaryDirectory() as directory:
        return toy_box.variant(kind, Path(directory), *overrides, plugins=plugins)


def dies_at(call: int) -> None:
    """Make this process kill itself at the *call*-th call of a function that writes to the disk."""
    left = [call]

    def dying(function: Callable[..., Any], *, after: bool) -> Callable[..., Any]:
        def wrapper(*arguments: Any) -> Any:
            left[0] -= 1
            if left[0] == 0 and not after:
                os.kill(os.getpid(), signal.SIGKILL)
            result = function(*arguments)
            if left[0] == 0:
                os.kill(os.getpid(), signal.SIGKILL)
            return result

        return wrapper

    evoframe.record.store._SYNC_INTERVAL = 0.0  # synchronize and write the champion's file after every turn
    store: Any = evoframe.record.store.Store
    store._write = dying(store._write, after=True)
    replace: Any = dying(Path.replace, after=call % 2 == 0)
    Path.replace = replace  # type: ignore[method-assign]


@contextlib.contextmanager
def forked(action: Callable[[int], None]) -> Iterator[tuple[int, int]]:
    """Yield the process id of a fork that runs *action*, and the reading end of its pipe."""
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        status = 1
        try:
            os.close(reading)
            action(writing)
            status = 0
        finally:
            os._exit(status)
    os.close(writing)
    try:
        yield child, reading
    finally:
        os.close(reading)


def attempt(directory: Path, seed: int, chance: random.Random) -> str:
    """Start or resume a run, kill it, and return ``finished``, ``outside``, ``inside`` or ``early``."""
    workers, inside, turns = chance.choice([1, 2]), chance.random() < 0.5, chance.randint(1, 3)
    call = chance.randint(6, 24)  # a turn writes about eight times

    def action(pipe: int) -> None:
        if inside:
            dies_at(call)
        play(directory, seed, workers, pipe)

    with forked(action) as (child, pipe):
        saved = 0
        while (inside or saved < turns) and os.read(pipe, 1):
            saved += 1
        if not inside:
            time.sleep(chance.uniform(0.0, _PAUSE))
            os.kill(child, signal.SIGKILL)
        _, status = os.waitpid(child, 0)
    if (directory / "run.db-journal").exists():
        raise SystemExit(f"seed {seed}: a kill left a journal that only a writer can roll back")
    if os.WIFEXITED(status):
        if os.WEXITSTATUS(status) != 0:
            raise SystemExit(f"seed {seed}: a run failed instead of being killed")
        return "finished"
    if saved == 0:
        return "early"
    return "inside" if inside else "outside"


def compare(directory: Path, uninterrupted: Path, seed: int) -> None:
    """Compare a run that was killed several times with an uninterrupted run."""
    with forked(lambda pipe: play(uninterrupted, seed, 2, pipe)) as (child, pipe):
        while os.read(pipe, 1024):
            pass
        _, status = os.waitpid(child, 0)
    if status != 0:
        raise SystemExit(f"seed {seed}: the uninterrupted run failed")
    assert_same_result(uninterrupted, directory)
    pairs = [[row[:2] for row in rows(each, "workload")] for each in (uninterrupted, directory)]
    assert pairs[0] == pairs[1]
    with contextlib.closing(sqlite3.connect(directory / "run.db")) as database:
        assert database.execute("PRAGMA integrity_check").fetchall() == [("ok",)]


def main() -> None:
    """Kill runs until ``--kills`` is reached; the last run is finished and compared too."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--kills", type=int, default=500)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    chance, seed = random.Random(given.seed), given.seed  # noqa: S311
    counts: collections.Counter[str] = collections.Counter()
    killed: collections.Counter[str] = collections.Counter()
    most = turns = 0
    with tempfile.TemporaryDirectory() as base:
        while killed.total() < given.kills or len(+killed) < len(GENERATIONS):
            directory, kills = Path(base) / f"killed-{seed}", 0
            while not (directory.exists() and has_begun(directory) and is_finished(directory)):
                how = attempt(directory, seed, chance)
                counts[how] += 1
                kills += how in ("inside", "outside")
            killed[kind_of(seed)] += kills
            compare(directory, Path(base) / f"uninterrupted-{seed}", seed)
            turns += load_run(directory).summary()["turns"]
            most, seed = max(most, kills), seed + 1
    kinds = ", ".join(f"{kind} {killed[kind]}" for kind in GENERATIONS)
    print(  # noqa: T201
        f"{killed.total()} kills after a saved turn ({counts['inside']} during a write) "
        f"and {counts['early']} before; {seed - given.seed} runs with {turns} turns in total "
        f"and at most {most} kills in one run ({kinds}): all results equal those of uninterrupted runs"
    )


if __name__ == "__main__":
    main()
