"""Directories of studies, and the runs in them."""

from __future__ import annotations

from pathlib import Path

import pytest
import toy_box
import toys
from toy_study import STUDY

from evoframe import InputError, run_study
from evoframe.study import is_study, runs_in


@pytest.fixture
def made(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
    (tmp_path / "grid.toml").write_text(STUDY)
    monkeypatch.chdir(tmp_path)
    run_study("grid.toml", out="s", modules=[toys.__file__], runs=1)
    return tmp_path / "s"


def test_a_study_is_known_by_its_file(made: Path) -> None:
    assert is_study(made)
    assert not is_study(made.parent)
    assert not is_study(made / "nowhere")


def test_the_runs_are_those_that_have_started(made: Path) -> None:
    runs = runs_in(made, toy_box.installed())
    assert len(runs) == 4
    (runs[0] / "config.toml").unlink()
    assert runs_in(made, toy_box.installed()) == runs[1:]


def test_a_study_without_runs_is_refused(made: Path) -> None:
    for path in runs_in(made, toy_box.installed()):
        (path / "config.toml").unlink()
    with pytest.raises(InputError) as caught:
        runs_in(made, toy_box.installed())
    assert caught.value.source == str(made)
