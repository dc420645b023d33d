"""What the figures were measured on, and with."""

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
"""Load from which other work may disturb the figures."""

_BUILD = Path(__file__).parent.parent / "extensions.py"


def machine() -> dict[str, str]:
    """Return what decides about times."""
    return {
        "processor": f"{_processor()}, {cores()} cores usable",
        "kernels": ", ".join(KERNELS),
        "compiler": f"{_first_line([*compiler(), '--version'])} (here and now)",
        "flags of libvox": " ".join(runpy.run_path(str(_BUILD))["FLAGS"]),
        "system": f"{platform.system()} {platform.release()}, {' '.join(platform.libc_ver())}",
        "python": platform.python_version(),
        **{name: version(name) for name in ("evoframe", "numpy", "neat-python")},
        "load at the start": f"{load():.2f}",
    }


def compiler() -> list[str]:
    """Return the command of the C compiler that builds extensions, as setuptools finds it."""
    return shlex.split(os.environ.get("CC") or sysconfig.get_config_var("CC") or "cc")


def load() -> float:
    """Return how many processes have wanted to work in the last minute; 0 where nobody knows."""
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
        said = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    except (OSError, subprocess.CalledProcessError):
        return f"none that answers to '{command[0]}'"
    return said.partition("\n")[0]
