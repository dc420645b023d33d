"""Kill workers at random moments, mostly while they start, and compare results with undisturbed ones.

``python tests/survival/worker_kills.py --kills 400 --busy 2`` is the long form (``make kills``); the suite
kills 60 times. Children of a run with the executor ``processes``, and of a study, are killed up to half a
second after their start, or later. No kill may delay the program, change a result, or show on the terminal
otherwise than as a message of evoframe.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import random
import re
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import attrs

sys.path.insert(0, str(Path(__file__).parent.parent / "support"))
from processes import children, surroundings
from recorded import assert_same_result

STUDY = """
extends = "quick"
runs = 1

[run]
seed = 7
generations = 20

[grid]
"collaboration.n" = [2, 3]
"""

_STALL = 20.0  # s; longest time in which a killed worker may remain without a replacement on a busy computer
_END = 120.0  # s; longest time that a program may take after the last kill
_NUMBER = re.compile(r"\d[\d.,]*(e-?\d+)?")
_PASSING = re.compile(  # lines of a log that depend on time, or report kills
    r"$|turn |.* runs done|evoframe\.workers\.processes: .* ended with the signal SIGKILL; its work is "
)


@attrs.define
class Killer:
    """Kills the children of a program, each at a random moment after its start.

    Attributes:
        chance: The random numbers.
        left: Number of kills left.
        longest: Longest time from a kill to the start of the next child, s.
    """

    chance: random.Random
    left: int
    longest: float = 0.0
    _due: dict[int, float] = attrs.field(factory=dict)
    _killed: list[float] = attrs.field(factory=list)

    def watch(self, program: subprocess.Popen[bytes]) -> None:
        """Kill until the program has ended."""
        self._due.clear()
        self._killed.clear()
        last = time.monotonic()
        while program.poll() is None:
            for child in set(children(program.pid)) - self._due.keys():
                self._due[child] = time.monotonic() + self._delay()
                if self._killed:
                    self.longest = max(self.longest, time.monotonic() - self._killed.pop(0))
            for child, due in self._due.items():
                if self.left > 0 and due <= time.monotonic():
                    self._due[child] = float("inf")
                    self.left -= 1
                    with contextlib.suppress(ProcessLookupError):
                        os.kill(child, signal.SIGKILL)
                        last = time.monotonic()
                        self._killed.append(last)
            if self._killed and time.monotonic() - self._killed[0] > _STALL:
                raise SystemExit(f"a killed worker was not replaced within {_STALL:g} s")
            if time.monotonic() - last > _END:
                raise SystemExit(f"the program did not end within {_END:g} s after the last kill")
            time.sleep(0.001)

    def _delay(self) -> float:
        return self.chance.uniform(0.0, 0.5) if self.chance.random() < 0.8 else self.chance.uniform(0.5, 2.0)


def evoframe(directory: Path, arguments: list[str], killer: Killer) -> list[str]:
    """Run a command while *killer* kills its children; return the lines of its log, without numbers."""
    log = directory / "log"
    with log.open("wb") as file:
        command = [sys.executable, "-m", "evoframe", *arguments]
        program = subprocess.Popen(
            command, cwd=directory, env=surroundings(), stdout=subprocess.DEVNULL, stderr=file
        )
        try:
            killer.watch(program)
        except SystemExit:
            sys.stderr.write(log.read_text())
            raise
        finally:
            program.kill()
            program.wait()
    text = log.read_text()
    if program.returncode != 0:
        raise SystemExit(f"{arguments[0]} ended with {program.returncode}:\n{text}")
    lines = {re.sub(_NUMBER, "#", line) for line in text.splitlines() if not re.match(_PASSING, line)}
    return sorted(lines)


def compare(base: Path, arguments: list[str], killer: Killer) -> int:
    """Execute a command with kills and without, compare what it wrote, and return the number of runs."""
    directories = [base / "killed", base / "undisturbed"]
    logs = []
    for directory, kills in zip(directories, (killer, Killer(killer.chance, 0)), strict=True):
        directory.mkdir()
        (directory / "study.toml").write_text(STUDY)
        logs.append(evoframe(directory, arguments, kills))
    if logs[0] != logs[1]:
        raise SystemExit(f"the logs differ: {logs}")
    runs = sorted(path.parent.relative_to(directories[0]) for path in directories[0].rglob("champion.json"))
    for run in runs:
        assert_same_result(*(directory / run for directory in directories))
    return len(runs)


@contextlib.contextmanager
def busy(processes: int) -> Iterator[None]:
    """Keep cores busy."""
    loops = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(processes)]
    try:
        yield
    finally:
        for loop in loops:
            loop.kill()
            loop.wait()


def main() -> None:
    """Kill until ``--kills`` is reached, half of them in runs and half in studies."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--kills", type=int, default=400)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--busy", type=int, default=0, help="number of processes that only use cores")
    given = parser.parse_args()
    chance = random.Random(given.seed)  # noqa: S311
    run = ["run", "quick", "--set", "executor={name='processes', workers=2}", "--set", "run.generations=20"]
    study = ["study", "study.toml", "--workers", "2", "--out", "s"]
    longest, compared, number = 0.0, 0, given.seed
    with tempfile.TemporaryDirectory() as base, busy(given.busy):
        for share, command in ((given.kills // 2, run), (given.kills - given.kills // 2, study)):
            killer = Killer(chance, share)
            while killer.left > 0:
                directory = Path(base) / str(number)
                directory.mkdir()
                compared += compare(directory, [*command, "--set", f"run.seed={number}"], killer)
                number += 1
            longest = max(longest, killer.longest)
    print(  # noqa: T201
        f"{given.kills} kills of workers, {compared} runs: all results and logs equal those without kills; "
        f"a killed worker was replaced within {longest:.2f} s"
    )


if __name__ == "__main__":
    main()
