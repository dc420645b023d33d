"""How much memory does a program need at most?"""

from __future__ import annotations

import json
import subprocess
import sys

__all__ = ["peak_memory"]

# A process counts the memory of the one that it was made from as its own, so that is a small one.
_LAUNCHER = """
import json, resource, subprocess, sys, time
began = time.perf_counter()
subprocess.run(sys.argv[1:], check=True, stdout=subprocess.DEVNULL)
seconds = time.perf_counter() - began
print(json.dumps([resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss, seconds]))
"""
_UNIT = 1 if sys.platform == "darwin" else 1024  # of ru_maxrss, bytes


def peak_memory(command: list[str]) -> tuple[float, float]:
    """Run a command in a process of its own.

    Returns:
        Its greatest resident size in MB, and how long it took, s.

    Raises:
        CalledProcessError: It failed.
    """
    launched = [sys.executable, "-c", _LAUNCHER, *command]
    said = subprocess.run(launched, check=True, stdout=subprocess.PIPE, text=True).stdout
    size, seconds = json.loads(said)
    return size * _UNIT / 1e6, seconds
