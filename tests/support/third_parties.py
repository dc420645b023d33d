"""Distributions of third parties, built and installed by pip."""

from __future__ import annotations

import shutil
from pathlib import Path

from processes import python

SOURCES = Path(__file__).parents[1] / "third_party"

_OPTIONS = ("--quiet", "--no-deps", "--no-build-isolation", "--no-index")


def installed(directory: Path, *names: str) -> Path:
    """Install distributions from ``tests/third_party``; return their folder, for PYTHONPATH."""
    sources = [directory / name for name in names]
    for source in sources:
        shutil.copytree(SOURCES / source.name, source)  # building leaves files behind
    ended = python("-m", "pip", "install", *_OPTIONS, "--target", directory / "site", *sources)
    assert ended.returncode == 0, ended.stderr
    return directory / "site"
