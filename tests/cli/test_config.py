"""``evoframe config``."""

from __future__ import annotations

import sys
import tomllib
from pathlib import Path

import pytest
from processes import Evoframe, with_pipe


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
    assert "'hm'" in refused.stderr


def test_config_show_with_comments_means_the_same(evoframe: Evoframe) -> None:
    shown = evoframe("config", "show", "quick", "--comments").stdout
    assert tomllib.loads(shown) == tomllib.loads(evoframe("config", "show", "quick").stdout)
    assert "# Number of individuals." in shown


def test_config_new_writes_a_file_that_can_be_run(evoframe: Evoframe, tmp_path: Path) -> None:
    written = evoframe("config", "new", "my.toml", "--preset", "quick")
    assert (written.returncode, written.stdout) == (0, "")
    assert "evoframe run my.toml" in written.stderr
    assert evoframe("config", "show", "my.toml").stdout == evoframe("config", "show", "quick").stdout
    assert evoframe("config", "new", "-", "--preset", "quick").stdout == (tmp_path / "my.toml").read_text()


def test_config_new_sets_every_option_if_its_preset_is_a_pipe(evoframe: Evoframe, tmp_path: Path) -> None:
    """A pipe cannot be extended later."""
    shown = evoframe("config", "show", "quick").stdout
    written = with_pipe(shown, "config", "new", "my.toml", "--preset", directory=tmp_path)
    assert written.returncode == 0, written.stderr
    assert evoframe("config", "show", "my.toml").stdout == shown


@pytest.mark.parametrize("base", ["base.toml", "presets/base.toml", 'a "quoted" name.toml'])
def test_config_new_extends_a_file_in_another_directory(
    evoframe: Evoframe, tmp_path: Path, base: str
) -> None:
    (tmp_path / "presets").mkdir()
    (tmp_path / "far" / "away").mkdir(parents=True)
    (tmp_path / "mine").symlink_to("far/away")
    (tmp_path / base).write_text("[run]\nseed = 2\n")
    assert evoframe("config", "new", "mine/my.toml", "--preset", base).returncode == 0
    assert evoframe("config", "show", "mine/my.toml").stdout == evoframe("config", "show", base).stdout


def test_config_new_overwrites_nothing_unasked(evoframe: Evoframe, tmp_path: Path) -> None:
    (tmp_path / "my.toml").write_text("[run]\nseed = 2\n")
    refused = evoframe("config", "new", "my.toml")
    assert refused.returncode == 2
    assert refused.stderr.startswith("Error: my.toml: ")
    assert (tmp_path / "my.toml").read_text() == "[run]\nseed = 2\n"
    assert evoframe("config", "new", "my.toml", "--force").returncode == 0
    assert (tmp_path / "my.toml").read_text() != "[run]\nseed = 2\n"


@pytest.mark.skipif(sys.platform != "linux", reason="needs names of any bytes")
def test_config_new_refuses_to_extend_a_file_that_toml_cannot_name(
    evoframe: Evoframe, tmp_path: Path
) -> None:
    (tmp_path / "b\udcff.toml").write_text('extends = "quick"')
    refused = evoframe("config", "new", "my.toml", "--preset", "b\udcff.toml")
    assert refused.returncode == 2
    assert refused.stderr.startswith("Error: b\\udcff.toml: ")
    assert not (tmp_path / "my.toml").exists()


def test_config_new_never_overwrites_the_preset_that_it_reads(evoframe: Evoframe, tmp_path: Path) -> None:
    text = "[run]\nseed = 2\n"
    (tmp_path / "base.toml").write_text(text)
    (tmp_path / "my.toml").write_text('extends = "base.toml"\n')
    for name in ("my.toml", "base.toml"):
        refused = evoframe("config", "new", name, "--preset", "my.toml", "--force")
        assert refused.returncode == 2
        assert refused.stderr.startswith(f"Error: {name}: is an input")
    assert (tmp_path / "base.toml").read_text() == text
