"""Is everything in order? An installation, or a run's directory, looked at without changing anything."""

from __future__ import annotations

import contextlib
import os
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any, Literal, TypeAlias

import attrs

from evoframe.config import load_config
from evoframe.contract import RunConfig
from evoframe.documents import differences
from evoframe.errors import EvoframeError, InputError
from evoframe.evolution import assemble, score_designs
from evoframe.files import LOCK_FILE, acquire_lock
from evoframe.messages import full_text
from evoframe.record import CHAINED, CHAMPION_FILE, SINGLE, Run, open_unchecked, provenance_of
from evoframe.registry import Plugins
from evoframe.runs.resuming import configuration_of, restore

__all__ = ["Check", "State", "check_installation", "check_run"]

State: TypeAlias = Literal["ok", "note", "problem"]


@attrs.frozen
class Check:
    """What was looked at, and what was found.

    Attributes:
        subject: What was looked at.
        state: ``ok``; ``note`` for what a person should know; ``problem`` for what must be mended.
        finding: What was found.
    """

    subject: str
    state: State
    finding: str


def check_installation(plugins: Plugins) -> Iterator[Check]:
    """Yield what is found out about an installation, one thing after the other."""
    for skipped in plugins.skipped:
        yield Check("plugins", "problem", f"{skipped.source} is skipped: {skipped.cause}")
    sources = {f"{source.distribution} {source.version}" for source in (o.source for o in plugins.offers)}
    found = f"{len(plugins.offers)} components of {', '.join(sorted(sources)) or 'nobody'}"
    yield Check("plugins", "ok" if plugins.offers else "problem", found)
    yield _checked("versions", lambda: _versions(load_config("paper", plugins=plugins)))
    yield _checked("simulation", lambda: _first_meeting(plugins))


def check_run(directory: Path, plugins: Plugins) -> Iterator[Check]:
    """Yield what is found out about a run's directory, up to what makes more of it meaningless.

    Raises:
        InputError: It is no run's directory, or another process is writing to it.
    """
    with _undisturbed(directory), open_unchecked(directory) as run:
        yield from _check_files(run, plugins)


def _check_files(run: Run, plugins: Plugins) -> Iterator[Check]:
    readable = _checked("format", lambda: _format(run))
    if not run.begun:
        if readable.state == "ok":
            todo = f"evoframe resume {run.directory}"
            finding = f"has no tables: killed before anything was saved; to begin: {todo}"
            yield Check("database", "note", finding)
        else:
            yield Check("database", "problem", readable.finding)
        return
    yield readable
    if readable.state == "problem":
        return
    yield (sound := _checked("database", lambda: _database(run)))
    try:
        config = configuration_of(run, (), plugins)
    except EvoframeError as error:
        yield Check("configuration", "problem", full_text(error))
        return
    yield Check("configuration", "ok", "can be used with the plugins that are installed")
    if sound.state == "problem":
        return
    yield _versions_then_and_now(run, config)
    yield _checked("turns", lambda: _turns(run, config))
    yield _checked("state", lambda: _state(run, config))
    yield _checked("champion", lambda: _champion(run, config))


def _checked(subject: str, look: Callable[[], str]) -> Check:
    try:
        return Check(subject, "ok", look())
    except EvoframeError as error:
        return Check(subject, "problem", full_text(error))


@contextlib.contextmanager
def _undisturbed(directory: Path) -> Iterator[None]:
    """Keep others from writing meanwhile; where nobody ever wrote or may write, nothing is made for that."""
    path = directory / LOCK_FILE
    with contextlib.ExitStack() as stack:
        if path.is_file() and not path.is_symlink() and os.access(path, os.W_OK):
            stack.callback(acquire_lock(directory).release)
        yield


def _versions(config: RunConfig) -> str:
    found = provenance_of(config)
    libraries = ", ".join(f"{name} {version}" for name, version in found["libraries"].items())
    return f"evoframe {found['evoframe']} on {found['machine']}, {found['c_library']}; {libraries}"


def _first_meeting(plugins: Plugins) -> str:
    """Begin a small run that is saved nowhere."""
    config = load_config("quick", overrides=["run.generations=0"], plugins=plugins)
    with assemble(config) as coevolution:
        turn = next(iter(coevolution))
    diverged = sum(pair.score is None for pair in turn.pairs)
    work = turn.workload
    return f"{work.simulations} simulations in {work.seconds:.2f} s, of which {diverged} diverged"


def _format(run: Run) -> str:
    run.check()
    return f"written by evoframe {run.config.get('provenance', {}).get('evoframe', 'of an unknown version')}"


def _database(run: Run) -> str:
    damage = run.damage()
    if damage:
        raise InputError(f"damaged: {'; '.join(damage)}")
    count = sum(len(run.rows(table)) for table in (*CHAINED, *SINGLE))  # compares their checksums
    return f"{count:,} rows, all as they were saved"


def _versions_then_and_now(run: Run, config: RunConfig) -> Check:
    changes = differences(run.config.get("provenance", {}), provenance_of(config))
    if not changes:
        return Check("versions", "ok", "those that the run began with")
    return Check("versions", "note", f"not those that the run began with: {'; '.join(changes)}")


def _turns(run: Run, config: RunConfig) -> str:
    for fault in _faults_of_turns(run, config):
        raise InputError(fault)
    last, length = run.last_turn(), config.run.generations * len(config.populations)
    if run.finished():
        return f"finished after {length} turns"
    done = "none is saved" if last is None else f"saved up to {last} of {length}"
    return f"{done}; to go on: evoframe resume {run.directory}"


def _faults_of_turns(run: Run, config: RunConfig) -> Iterator[str]:
    """Yield where rows are missing, or contradict each other."""
    work, roles = run.workload(), list(config.populations)
    turns = range(len(work))
    if [row["turn"] for row in work] != list(turns):
        yield "workload: turns are missing"
    judged = {(turn, role) for turn in turns for role in _judged(turn, roles, config)}
    if {(row["turn"], row["population"]) for row in run.turns()} != judged:
        yield "turns: not those populations were judged whose turn it was"
    members = Counter((row["turn"], row["population"]) for row in run.individuals())
    if members != {(turn, role): config.populations[role].size for turn, role in judged}:
        yield "individuals: not as many as the populations have"
    pairs = Counter(row["turn"] for row in run.pairs())
    if pairs != {row["turn"]: row["pairs"] for row in work if row["pairs"]}:
        yield "pairs: not as many as in workload"
    yield from _faults_of_best_pairs(run.table("best_pairs"), run.pairs())


def _judged(turn: int, roles: list[str], config: RunConfig) -> Iterable[str]:
    """Return the populations that are judged in a turn."""
    if turn == 0:
        return roles
    if turn > config.run.generations * len(roles):
        return []  # the closing meeting
    return [roles[(turn - 1) % len(roles)]]


def _faults_of_best_pairs(
    best_pairs: Iterable[Mapping[str, Any]], pairs: Iterable[Mapping[str, Any]]
) -> Iterator[str]:
    """Yield the turns whose best pair is not the best of that turn, or no better than those before."""
    best: dict[int, float] = {}
    for pair in pairs:
        if pair["score"] is not None:
            best[pair["turn"]] = max(pair["score"], best.get(pair["turn"], pair["score"]))
    expected, record = [], None
    for turn, score in sorted(best.items()):
        if record is None or score > record:
            record = score
            expected.append((turn, score))
    if [(row["turn"], row["score"]) for row in best_pairs] != expected:
        yield "best_pairs: not the best of the pairs"


def _state(run: Run, config: RunConfig) -> str:
    with assemble(config) as coevolution:
        restore(coevolution, run)
    return "can be restored"


def _champion(run: Run, config: RunConfig) -> str:
    if run.champion_document() is None:
        return "there is none yet"
    champion, objective = run.champion(), config.objective.component
    [score] = score_designs(config.simulator.component, [champion.design], objective.record, objective)
    if score.value != champion.score:
        now = f"diverges at step {score.diverged_at}" if score.value is None else f"scores {score.value!r}"
        raise InputError(f"scored {champion.score!r} in its run, but now {now}")
    return f"scores {champion.score!r}, as in its run{_champion_file(run)}"


def _champion_file(run: Run) -> str:
    """Return what there is to say of champion.json."""
    if run.champion_is_written():
        return ""
    todo = f"evoframe resume {run.directory} writes it again"
    if run.finished():
        raise InputError(f"{run.directory / CHAMPION_FILE}: is not that of the database; {todo}")
    return f"; {CHAMPION_FILE} is not up to date: {todo}"
