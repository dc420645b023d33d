"""``evoframe config``."""

from __future__ import annotations

import tomllib
from pathlib import Path

from processes import Evoframe


def test_config_show_prints_what_can_be_run(evoframe: Evoframe, tmp_path: Path) -> None:
    shown = evoframe("config", "show", "quick", "--set", "aggregator=hm")
    assert shown.returncode == 0
    tables = tomllib.loads(shown.stdout)
    assert tables["aggregator"] == {"name": "hm", "floor": 1e-5, "clip": False}
    (tmp_path / "shown.toml").write_text(shown.stdout)
    assert evoframe("config", "show", "shown.toml").stdout == shown.stdout


def test_config_show_refuses_what_cannot_be_run(evoframe: Evoframe) -> None:
    refused = evoframe("config", "show", "quick", "--set", "aggregator=hmm")
    assert (refused.returncode, refused.stdout) == (2, "")
    assert "unknown aggregator 'hmm'; did you mean 'hm'?" in refused.stderr
