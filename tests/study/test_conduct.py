"""The directory of a study, which several processes share."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from evoframe import InputError
from evoframe.study.conduct import STUDY_FILE, alone, claim, refuse_another
from evoframe.study.plan import Study

Read = Callable[..., Study]


def test_what_another_process_leaves_before_it_has_claimed_a_directory_is_no_obstacle(
    toy_study: Read, tmp_path: Path
) -> None:
    there = tmp_path / "there"
    there.mkdir()
    with alone(there):
        (there / f".{STUDY_FILE}.new").write_text("half")
        refuse_another(toy_study(), there)
    claim(toy_study(), there)
    assert (there / STUDY_FILE).is_file()


def test_a_directory_that_is_claimed_while_one_looks_is_that_of_the_study(
    toy_study: Read, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    study, there = toy_study(), tmp_path / "there"
    there.mkdir()
    look = Path.iterdir

    def claimed_meanwhile(path: Path) -> object:
        with monkeypatch.context() as patch:
            patch.setattr(Path, "iterdir", look)
            claim(study, there)
        return look(path)

    monkeypatch.setattr(Path, "iterdir", claimed_meanwhile)
    refuse_another(study, there)


def test_what_is_somebody_elses_stays_as_it_is(toy_study: Read, tmp_path: Path) -> None:
    (tmp_path / "there").mkdir()
    (tmp_path / "there" / "letter").touch()
    with pytest.raises(InputError, match="is not empty, and not the directory of a study"):
        claim(toy_study(), tmp_path / "there")
    assert [path.name for path in (tmp_path / "there").iterdir()] == ["letter"]
