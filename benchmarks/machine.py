"""Description of the machine and the software of a benchmark."""

from __future__ import annotations

import os
import platform
import runpy
import shlex
import subprocess
import sysconfig
from importlib.metadata import version
from pathlib import Path

from evoframe_libvox import KERNELS

__all__ = ["BUSY", "compiler", "cores", "load", "machine"]

BUSY = 0.3
"""Load above which other processes may disturb the figures."""

_BUILD = Path(__file__).parent.parent / "extensions.py"


def machine() -> dict[str, str]:
    """Return the properties of the machine and the software that affect times."""
    return {
        "processor": f"{_processor()}, {cores()} cores usable",
        "kernels": ", ".join(KERNELS),
        "compiler": f"{_first_line([*compiler(), '--version'])} (of this environment)",
        "flags of libvox": " ".join(runpy.run_path(str(_BUILD))["FLAGS"]),
        "system": f"{platform.system()} {platform.release()}, {' '.join(platform.libc_ver())}",
        "python": platform.python_version(),
        **{name: version(name) for name in ("evoframe", "numpy", "neat-python")},
        "load at the start": f"{load():.2f}",
    }


def compiler() -> list[str]:
    """Return the command of the C compiler that builds extensions, found as setuptools does."""
    return shlex.split(os.environ.get("CC") or sysconfig.get_config_var("CC") or "cc")


def load() -> float:
    """Return the load average of the last minute; 0 if the system does not provide it."""
    return os.getloadavg()[0] if hasattr(os, "getloadavg") else 0.0


def cores() -> int:
    """Return the number of cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _processor() -> str:
    information = Path("/proc/cpuinfo")
    lines = information.read_text(encoding="utf-8").splitlines() if information.exists() else []
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.processor() or platform.machine()


def _first_line(command: list[str]) -> str:
    try:
        printed = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    except (OSError, subprocess.CalledProcessError):
        return f"none: '{command[0]}' cannot be executed"
    return printed.partition("\n")[0]
