"""Fixtures shared by the tests of simulators."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import pytest

from evoframe.cli import cli

EXAMPLES = Path(__file__).parents[2] / "data" / "vxa"


@pytest.fixture
def simulated(capsys: pytest.CaptureFixture[str]) -> Callable[[Path], tuple[int, str]]:
    """Run ``evoframe simulate FILE`` in this process; return its exit code and stderr."""

    def simulate(path: Path) -> tuple[int, str]:
        with pytest.raises(SystemExit) as left:
            cli(["simulate", str(path)], prog_name="evoframe")
        return int(str(left.value.code)), capsys.readouterr().err

    return simulate


@pytest.fixture
def vxa(tmp_path: Path) -> Callable[..., Path]:
    """Write one of the example files with changes, and return its path.

    ``vxa(tag=value)`` replaces the text of the first element of this name; ``vxa(after={line: more})``
    inserts text after the first occurrence of a line, and ``vxa(without=[tag])`` removes an element.
    """

    def write(
        source: str = "template",
        *,
        after: Mapping[str, str] | None = None,
        without: Sequence[str] = (),
        **texts: object,
    ) -> Path:
        text = (EXAMPLES / f"{source}.vxa").read_text(encoding="utf-8")
        for tag, value in texts.items():
            text, found = re.subn(rf"<{tag}>[^<]*</{tag}>", f"<{tag}>{value}</{tag}>", text, count=1)
            assert found, f"no {tag} in the example"
        for line, more in (after or {}).items():
            assert line in text
            text = text.replace(line, f"{line}\n{more}", 1)
        for tag in without:
            text, found = re.subn(rf"<{tag}[ >].*?</{tag}>\n", "", text, count=1, flags=re.DOTALL)
            assert found, f"no {tag} in the example"
        path = tmp_path / "given.vxa"
        path.write_text(text, encoding="utf-8")
        return path

    return write
