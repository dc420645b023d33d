"""The program as a person starts it."""

from __future__ import annotations

import functools
from pathlib import Path

import pytest
from processes import Evoframe, python


@pytest.fixture
def evoframe(tmp_path: Path) -> Evoframe:
    return functools.partial(python, "-m", "evoframe", directory=tmp_path, COLUMNS="100")
