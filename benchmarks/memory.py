"""Peak memory of a program."""

from __future__ import annotations

import json
import subprocess
import sys

__all__ = ["peak_memory"]

# A process inherits the peak memory of its parent, so the parent is a small launcher.
_LAUNCHER = """
import json, resource, subprocess, sys, time
began = time.perf_counter()
subprocess.run(sys.argv[1:], check=True, stdout=subprocess.DEVNULL)
seconds = time.perf_counter() - began
print(json.dumps([resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss, seconds]))
"""
_UNIT = 1 if sys.platform == "darwin" else 1024  # of ru_maxrss, bytes


def peak_memory(command: list[str]) -> tuple[float, float]:
    """Run a command in its own process.

    Returns:
        Its peak resident size, MB, and its duration, s.

    Raises:
        CalledProcessError: The command failed.
    """
    launched = [sys.executable, "-c", _LAUNCHER, *command]
    printed = subprocess.run(launched, check=True, stdout=subprocess.PIPE, text=True).stdout
    size, seconds = json.loads(printed)
    return size * _UNIT / 1e6, seconds
