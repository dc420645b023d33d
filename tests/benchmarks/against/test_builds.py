"""Another commit is built beside this version, and a failure names its cause."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from benchmarks.against.builds import build, describe
from benchmarks.report import SectionError

GIT = shutil.which("git") or ""

pytestmark = pytest.mark.skipif(not GIT, reason="needs git")

PROJECT = """
[build-system]
requires = ["setuptools"]
build-backend = "setuptools.build_meta"
[project]
name = "evoframe"
version = "{version}"
dependencies = {dependencies}
[tool.setuptools]
packages = ["evoframe"]
"""


@pytest.fixture
def checkout(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A repository whose only commit has a small package of the same name."""
    monkeypatch.setenv("PIP_NO_INDEX", "1")
    root = tmp_path / "checkout"
    (root / "evoframe").mkdir(parents=True)
    (root / "evoframe" / "__init__.py").write_text("version = 1\n")
    (root / "pyproject.toml").write_text(PROJECT.format(version="1", dependencies='["numpy"]'))
    git(root, "init", "--quiet")
    commit(root, "Add a package")
    return root


def git(root: Path, *arguments: str) -> None:
    subprocess.run([GIT, "-C", str(root), *arguments], check=True, capture_output=True)


def commit(root: Path, subject: str) -> None:
    git(root, "add", ".")
    names = ("-c", "user.name=A", "-c", "user.email=a@example.org")
    git(root, *names, "commit", "--quiet", "-m", subject)


def test_the_commit_is_built_and_not_the_working_tree(checkout: Path, tmp_path: Path) -> None:
    (checkout / "evoframe" / "__init__.py").write_text("version = 2\n")
    built = build(checkout, "HEAD", tmp_path)
    assert (built.site / "evoframe" / "__init__.py").read_text() == "version = 1\n"
    assert not list(built.site.glob("numpy*"))  # of this environment
    assert built.about.endswith(" Add a package")
    assert describe(checkout) == f"{built.about}, with uncommitted changes"


def test_a_clean_checkout_is_described_by_its_commit(checkout: Path) -> None:
    assert describe(checkout).endswith(" Add a package")


def test_a_requirement_that_cannot_be_installed_is_an_error(checkout: Path, tmp_path: Path) -> None:
    (checkout / "pyproject.toml").write_text(PROJECT.format(version="1", dependencies='["numpy>1000"]'))
    commit(checkout, "Require too much")
    with pytest.raises(SectionError, match=r"(?s)cannot build \w+ Require too much:.*numpy>1000"):
        build(checkout, "HEAD", tmp_path)


def test_a_failed_build_is_an_error(checkout: Path, tmp_path: Path) -> None:
    (checkout / "setup.py").write_text("raise OSError('no such compiler')\n")
    commit(checkout, "Fail")
    with pytest.raises(SectionError, match=r"(?s)cannot build \w+ Fail:.*no such compiler"):
        build(checkout, "HEAD", tmp_path)


@pytest.mark.parametrize("revision", ["missing", "-missing", ""])
def test_an_unknown_revision_is_an_error(checkout: Path, tmp_path: Path, revision: str) -> None:
    with pytest.raises(SectionError, match=f"'{revision}' is not a commit"):
        build(checkout, revision, tmp_path)


def test_a_folder_that_is_not_a_checkout_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(SectionError, match="not a git repository"):
        describe(tmp_path)


def test_without_git_the_error_names_it(checkout: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "")
    with pytest.raises(SectionError, match=r"--against requires git .*: git: No such file"):
        describe(checkout)
