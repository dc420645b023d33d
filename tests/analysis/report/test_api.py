"""Tests of writing reports of runs and studies."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
import toy_box
import toys

from evoframe import Plugins, Run, run
from evoframe.analysis.data import StudyData
from evoframe.analysis.report import Report, api, report
from evoframe.analysis.report.draft import Draft
from evoframe.analysis.report.study_report import draft_of_study
from evoframe.analysis.statistics import Correction
from evoframe.errors import InputError
from evoframe.study.plan import Planned, Study


@pytest.fixture
def plugins() -> Plugins:
    return toy_box.installed()


@pytest.fixture
def short(plugins: Plugins, tmp_path: Path) -> Run:
    """Return a run of toys."""
    (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
    return run(tmp_path / "toy.toml", out=tmp_path / "r", plugins=plugins)


def contents(made: Report) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in made.files}


def test_a_run_and_its_directory_give_the_same_report(short: Run, plugins: Plugins, tmp_path: Path) -> None:
    first = report(short, plugins=plugins)
    assert first.directory == short.directory / "report"
    assert set(first.files) == set(first.directory.iterdir())
    for source in (short.directory, str(short.directory)):
        again = report(source, out=tmp_path / "there", plugins=plugins)
        assert again.directory == tmp_path / "there"
        assert contents(again) == contents(first)
        assert again.words == first.words


def test_the_report_of_a_study_has_conclusions(
    made: tuple[Study, Path, list[Planned]],
    toy_plugins: Plugins,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    study, directory, _ = made
    (directory / "study.toml").write_bytes((tmp_path / "study.toml").read_bytes())
    shutil.copy(tmp_path / "toy.toml", directory)
    corrections = []

    def draft(data: StudyData, plugins: Plugins, correction: Correction) -> Draft:
        corrections.append(correction)
        return draft_of_study(data, plugins, correction)

    monkeypatch.setattr(api, "draft_of_study", draft)
    written = report(directory, correction="none", plugins=toy_plugins)
    assert corrections == ["none"]
    assert written.words == (written.directory / "conclusions.txt").read_text()
    assert written.words.startswith(f"here: {len(study.cells)} of ")


def test_nothing_is_written_into_the_directory_of_something_else(
    short: Run, plugins: Plugins, tmp_path: Path
) -> None:
    before = sorted(short.directory.iterdir())
    with pytest.raises(InputError, match=r"config\.toml.* --out") as caught:
        report(short, out=short.directory, plugins=plugins)
    assert caught.value.source == str(short.directory)
    assert sorted(short.directory.iterdir()) == before
    (tmp_path / "file").touch()
    with pytest.raises(InputError, match="Not a directory") as caught:
        report(short, out=tmp_path / "file" / "r", plugins=plugins)
    assert caught.value.source == str(tmp_path / "file" / "r")


def test_a_directory_without_a_run_or_study_is_rejected(plugins: Plugins, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"config\.toml.*study\.toml") as caught:
        report(tmp_path, plugins=plugins)
    assert caught.value.source == str(tmp_path)
    assert not (tmp_path / "report").exists()
