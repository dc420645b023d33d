"""Commands in forks of one process, whose standard streams are broken before Python starts.

A fork starts in milliseconds, although it has loaded all that commands load. Arguments: a file for the
outcomes, ``missing`` or ``given``, and a JSON list of commands, each with the directory to run it in.
"""

from __future__ import annotations

import importlib
import json
import os
import sys
import traceback
from pathlib import Path

_LOADED = ("evoframe.analysis.report", "evoframe.analysis.robustness", "evoframe.cli", "evoframe_simulators")


def outcome(arguments: list[str]) -> int | str:
    """Run a command in this process; return its exit code, or the traceback that would end it."""
    from evoframe.cli import main  # noqa: PLC0415 - after the streams were broken

    # As the system passes them, whatever the locale.
    sys.argv = ["evoframe", *(os.fsdecode(word.encode("utf-8", "surrogateescape")) for word in arguments)]
    try:
        main()
    except SystemExit as end:
        return int(end.code or 0)
    except BaseException:  # noqa: BLE001 - the result of the test
        return traceback.format_exc()
    return "main() returned"


def forked(directory: str, arguments: list[str], path: Path) -> int | str:
    """Run a command in a fork."""
    child = os.fork()
    if child == 0:
        os.chdir(directory)
        path.write_text(json.dumps(outcome(arguments)))
        # As at a normal end of Python.
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(0)
    os.waitpid(child, 0)
    found: int | str = json.loads(path.read_text())
    path.unlink()
    return found


def run_all(path: Path, streams: str, commands: str) -> None:
    """Run all commands, and write their outcomes."""
    for module in _LOADED:
        importlib.import_module(module)
    if streams == "missing":  # as in pythonw.exe
        sys.stdout = sys.stderr = None
    found = [
        forked(directory, arguments, path.with_suffix(".one"))
        for directory, arguments in json.loads(commands)
    ]
    path.write_text(json.dumps(found))


if __name__ == "__main__":
    run_all(Path(sys.argv[1]), *sys.argv[2:])
