"""``evoframe completion``, and what shells complete."""

from __future__ import annotations

import pytest
from processes import Evoframe


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_shells_complete(evoframe: Evoframe, shell: str) -> None:
    assert "_EVOFRAME_COMPLETE" in evoframe("completion", shell).stdout


def test_presets_are_completed(evoframe: Evoframe) -> None:
    completed = evoframe(COMP_WORDS="evoframe run pa", COMP_CWORD="2", _EVOFRAME_COMPLETE="bash_complete")
    assert "plain,paper" in completed.stdout


def test_studies_are_completed(evoframe: Evoframe) -> None:
    completed = evoframe(COMP_WORDS="evoframe study sm", COMP_CWORD="2", _EVOFRAME_COMPLETE="bash_complete")
    assert "plain,small" in completed.stdout


def test_an_unknown_shell_is_refused(evoframe: Evoframe) -> None:
    refused = evoframe("completion", "csh")
    assert refused.returncode == 2
    assert "'bash', 'zsh', 'fish'" in refused.stderr
