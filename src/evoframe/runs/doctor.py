"""Checks of an installation or of a run's directory, without changing anything."""

from __future__ import annotations

import contextlib
import os
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any, Literal, TypeAlias

import attrs

from evoframe.config import load_config
from evoframe.contract import RunConfig, whole_of
from evoframe.errors import EvoframeError, InputError
from evoframe.evolution import assemble, score_designs, timing_of
from evoframe.files import LOCK_FILE, acquire_lock, parsed_json
from evoframe.messages import full_text
from evoframe.record import (
    CHAINED,
    CHAMPION_FILE,
    SINGLE,
    Run,
    changed_provenance,
    changed_scoring,
    open_unchecked,
    provenance_of,
)
from evoframe.registry import Plugins
from evoframe.runs.blame import assembled
from evoframe.runs.restoring import configuration_of, restore

__all__ = ["Check", "State", "check_installation", "check_run"]

State: TypeAlias = Literal["ok", "note", "problem"]


@attrs.frozen
class Check:
    """The result of one check.

    Attributes:
        subject: Name of the check.
        state: ``ok``; ``note`` for information; ``problem`` for a fault to be fixed.
        finding: The result as a sentence.
    """

    subject: str
    state: State
    finding: str


def check_installation(plugins: Plugins) -> Iterator[Check]:
    """Check an installation, and yield each result as soon as it is known."""
    for skipped in plugins.skipped:
        yield Check("plugins", "problem", f"{skipped.source} is skipped: {skipped.cause}")
    sources = {f"{source.distribution} {source.version}" for source in (o.source for o in plugins.offers)}
    found = f"{len(plugins.offers)} components from {', '.join(sorted(sources)) or 'no plugin'}"
    yield Check("plugins", "ok" if plugins.offers else "problem", found)
    yield _check("versions", lambda: _versions(load_config("paper", plugins=plugins)))
    yield _check("simulation", lambda: _initial_meeting(plugins))


def check_run(directory: Path, plugins: Plugins) -> Iterator[Check]:
    """Check a run's directory, and yield each result; a problem ends the checks that depend on it.

    Raises:
        InputError: It is not a run's directory, or another process is writing to it.
    """
    with _locked_if_writable(directory), open_unchecked(directory) as run:
        yield from _check_files(run, plugins)


def _check_files(run: Run, plugins: Plugins) -> Iterator[Check]:
    readable = _check("format", lambda: _format(run))
    if not run.begun:
        if readable.state == "ok":
            todo = f"evoframe resume {run.directory}"
            finding = f"no tables: the run was killed before its first save; to start it: {todo}"
            yield Check("database", "note", finding)
        else:
            yield Check("database", "problem", readable.finding)
        return
    yield readable
    if readable.state == "problem":
        return
    yield (intact := _check("database", lambda: _database(run)))
    try:
        run.check_configuration()
        config = configuration_of(run, (), plugins)
    except EvoframeError as error:
        yield Check("configuration", "problem", full_text(error))
        return
    yield Check("configuration", "ok", "valid with the installed plugins")
    if intact.state == "problem":
        return
    yield _versions_then_and_now(run, config)
    yield _check("turns", lambda: _turns(run, config))
    yield _check("state", lambda: _state(run, config))
    yield _check("champion", lambda: _champion(run, config))


def _check(subject: str, examine: Callable[[], str | Check]) -> Check:
    try:
        found = examine()
    except EvoframeError as error:
        return Check(subject, "problem", full_text(error))
    return found if isinstance(found, Check) else Check(subject, "ok", found)


@contextlib.contextmanager
def _locked_if_writable(directory: Path) -> Iterator[None]:
    """Lock the directory, unless its lock file is missing or read-only: no file is created or changed."""
    path = directory / LOCK_FILE
    with contextlib.ExitStack() as stack:
        if path.is_file() and not path.is_symlink() and os.access(path, os.W_OK):
            stack.callback(acquire_lock(directory).release)
        yield


def _versions(config: RunConfig) -> str:
    found = provenance_of(config)
    libraries = ", ".join(f"{name} {version}" for name, version in found["libraries"].items())
    return f"evoframe {found['evoframe']} on {found['machine']}, {found['c_library']}; {libraries}"


def _initial_meeting(plugins: Plugins) -> str:
    """Simulate the initial turn of a small run, without saving it."""
    config = load_config("quick", overrides=["run.generations=0"], plugins=plugins)
    whole = attrs.evolve(config.simulator, component=whole_of(config.simulator.component))
    with assemble(attrs.evolve(config, simulator=whole)) as coevolution:
        turn = next(iter(coevolution))
    diverged = sum(pair.score is None for pair in turn.pairs)
    work = turn.workload
    return f"{work.simulations} simulations in {work.seconds:.2f} s, of which {diverged} diverged"


def _format(run: Run) -> str:
    run.check_database()
    return f"written by evoframe {run.config.get('provenance', {}).get('evoframe', '(version unknown)')}"


def _database(run: Run) -> str:
    damage = run.damage()
    if damage:
        raise InputError(f"damaged: {'; '.join(damage)}")
    count = sum(len(run.rows(table)) for table in (*CHAINED, *SINGLE))  # verifies their checksums
    return f"{count:,} rows match their checksums"


def _versions_then_and_now(run: Run, config: RunConfig) -> Check:
    changes = [
        ("changed since the start of the run", changed_provenance(run, config)),
        *((f"when the run was resumed {_after(row)}", _recorded(row)) for row in run.resumes()),
    ]
    found = [f"{when}: {'; '.join(lines)}" for when, lines in changes if lines]
    if not found:
        return Check("versions", "ok", "unchanged since the start of the run")
    return Check("versions", "note", "; ".join(found))


def _after(resume: Mapping[str, Any]) -> str:
    turn = resume["after_turn"]
    return "before its first turn" if turn is None else f"after turn {turn}"


def _recorded(resume: Mapping[str, Any]) -> list[str]:
    """Return the differences that were recorded with a resume."""
    lines = parsed_json(resume["differences"])
    return [str(line) for line in lines] if isinstance(lines, list) else []


def _turns(run: Run, config: RunConfig) -> str:
    for table, fault in _faults_of_turns(run, config):
        raise InputError(fault, key=table)
    last, length = run.last_turn(), timing_of(config).length
    if run.finished():
        return f"finished after {length} turns"
    done = "no turn is saved" if last is None else f"saved up to turn {last} of {length}"
    return f"{done}; to resume: evoframe resume {run.directory}"


def _faults_of_turns(run: Run, config: RunConfig) -> Iterator[tuple[str, str]]:
    """Yield tables whose rows are incomplete or contradict other tables, each with the fault."""
    work, roles = run.workload(), list(config.populations)
    turns = range(len(work))
    if [row["turn"] for row in work] != list(turns):
        yield "workload", "turns are missing"
    found = {(row["turn"], row["population"]) for row in run.turns()}
    evaluated = {(turn, role) for turn in turns for role in _evaluated(turn, roles, config, found)}
    if found != evaluated:
        yield "turns", "the evaluated populations differ from those whose turn it was"
    members = Counter((row["turn"], row["population"]) for row in run.individuals())
    if members != {(turn, role): config.populations[role].size for turn, role in evaluated}:
        yield "individuals", "their number differs from the sizes of the populations"
    pairs = Counter(row["turn"] for row in run.pairs())
    if pairs != {row["turn"]: row["pairs"] for row in work if row["pairs"]}:
        yield "pairs", "their number differs from the table workload"
    yield from _faults_of_best_pairs(run.table("best_pairs"), run.pairs())


def _evaluated(
    turn: int, roles: list[str], config: RunConfig, found: Collection[tuple[int, str]]
) -> Iterable[str]:
    """Return the populations that are evaluated in a turn."""
    timing = timing_of(config)
    if turn == 0:
        return roles
    if turn > timing.length:
        return []  # the turn of the final pair
    if timing.kind == "asynchronous":  # the order depends on the numbers of pairs: any one
        return [role for role in roles if (turn, role) in found][:1]
    return [roles[index] for index in timing.reproducing(turn, ())]


def _faults_of_best_pairs(
    best_pairs: Iterable[Mapping[str, Any]], pairs: Iterable[Mapping[str, Any]]
) -> Iterator[tuple[str, str]]:
    """Yield a fault unless *best_pairs* are exactly the pairs with a score above all of earlier turns."""
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
        yield "best_pairs", "differs from the best of the table pairs"


def _state(run: Run, config: RunConfig) -> str:
    with assembled(config) as coevolution:
        restore(coevolution, run, config)
    return "can be restored"


def _champion(run: Run, config: RunConfig) -> str | Check:
    """Simulate the champion again; only a score of the same bit generation must be reproduced."""
    if run.champion_document() is None:
        return "no pair has a score yet"
    champion, objective, simulator = run.champion(), config.objective.component, config.simulator.component
    score, whole = (
        score_designs(each, [champion.design], objective.record, objective)[0]
        for each in (simulator, whole_of(simulator))
    )
    if score.value != champion.score:
        now = f"diverges at step {score.diverged_at}" if score.value is None else f"scores {score.value!r}"
        finding = f"scored {champion.score!r} in the run, but now {now}"
        if changes := changed_scoring(run, config):
            return Check("champion", "note", f"{finding}: {changes}{_champion_file(run)}")
        raise InputError(finding)
    found = f"scores {champion.score!r}, as in the run{_champion_file(run)}"
    if whole.value is None:
        unseen = f"diverges at step {whole.diverged_at}, out of reach of the samples"
        return Check("champion", "note", f"{found}; but it {unseen}, which the score does not show")
    return found


def _champion_file(run: Run) -> str:
    """Return a remark on champion.json; empty if it is up to date."""
    if run.champion_is_written():
        return ""
    todo = f"to write it again: evoframe resume {run.directory}"
    if run.finished():
        raise InputError(f"differs from the database; {todo}", source=run.directory / CHAMPION_FILE)
    return f"; {CHAMPION_FILE} is out of date; {todo}"
