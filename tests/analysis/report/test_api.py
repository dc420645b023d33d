"""A report is a function of a run or a study."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
import toy_box
import toys

from evoframe import Plugins, Run, run
from evoframe.analysis.report import Report, report
from evoframe.errors import InputError
from evoframe.study.plan import Planned, Study


@pytest.fixture
def plugins() -> Plugins:
    return toy_box.installed()


@pytest.fixture
def short(plugins: Plugins, tmp_path: Path) -> Run:
    """A run of toys."""
    (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
    return run(tmp_path / "toy.toml", out=tmp_path / "r", plugins=plugins)


def contents(made: Report) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in made.files}


def test_an_object_and_its_directory_give_the_same(short: Run, plugins: Plugins, tmp_path: Path) -> None:
    first = report(short, plugins=plugins)
    assert first.directory == short.directory / "report"
    assert set(first.files) == set(first.directory.iterdir())
    for source in (short.directory, str(short.directory)):
        again = report(source, out=tmp_path / "there", plugins=plugins)
        assert again.directory == tmp_path / "there"
        assert contents(again) == contents(first)
        assert again.words == first.words


def test_of_a_study_it_has_the_conclusions(
    made: tuple[Study, Path, list[Planned]], toy_plugins: Plugins, tmp_path: Path
) -> None:
    study, directory, _ = made
    (directory / "study.toml").write_bytes((tmp_path / "study.toml").read_bytes())
    shutil.copy(tmp_path / "toy.toml", directory)
    written = report(directory, correction="none", plugins=toy_plugins)
    assert written.words == (written.directory / "conclusions.txt").read_text()
    assert written.words.startswith(f"here: {len(study.cells)} of ")
    assert b",none," in contents(written)["pairs.csv"]


def test_nothing_is_written_where_it_does_not_belong(short: Run, plugins: Plugins, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"is no place for a report: it has a config\.toml"):
        report(short, out=short.directory, plugins=plugins)
    (tmp_path / "file").touch()
    with pytest.raises(InputError, match="cannot be used for a report"):
        report(short, out=tmp_path / "file" / "r", plugins=plugins)


def test_neither_a_run_nor_a_study_is_refused(plugins: Plugins, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"is no directory of a run or a study: there is no config\.toml"):
        report(tmp_path, plugins=plugins)
    assert not (tmp_path / "report").exists()
