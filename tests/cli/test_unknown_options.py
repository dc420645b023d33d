"""An unknown option that is a setting is named with --set."""

from __future__ import annotations

import pytest
from processes import Evoframe


@pytest.mark.parametrize(
    ("command", "hints"),
    [
        ("run --generations 3", ["--set run.generations=VALUE"]),
        ("run --n 5", ["--set collaboration.n=VALUE"]),
        ("run --size 5", ["--set populations.morphology.size=VALUE", "populations.controller.size=VALUE"]),
        ("study small --seed 3", ["--set run.seed=VALUE"]),
        ("run --preset quick", ["evoframe run quick"]),
        ("run --sed 3", ["--seed"]),
        ("simulate --preste quick", ["--preset"]),
    ],
)
def test_what_was_meant_is_named(evoframe: Evoframe, command: str, hints: list[str]) -> None:
    refused = evoframe(*command.split())
    assert refused.returncode == 2
    assert command.split()[-2] in refused.stderr
    assert all(hint in refused.stderr for hint in hints)


def test_a_command_without_settings_gives_no_hint(evoframe: Evoframe) -> None:
    assert "--set" not in evoframe("doctor", "--generations").stderr
