"""Programs in processes of their own, as a person starts them."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

Evoframe = Callable[..., subprocess.CompletedProcess[str]]
"""Takes the arguments of ``evoframe``, and changes to the environment as keyword arguments."""


def python(
    *arguments: object, directory: Path | None = None, **environment: str
) -> subprocess.CompletedProcess[str]:
    """Run this Python with changes to the environment; whether it failed is for the caller to see."""
    return subprocess.run(
        [sys.executable, *map(str, arguments)],
        cwd=directory,
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        check=False,
    )
