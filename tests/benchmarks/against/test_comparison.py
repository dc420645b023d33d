"""``python -m benchmarks --against`` compares this version with a commit of its repository."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest
from processes import python

ROOT = Path(__file__).parents[3]

checkout = pytest.mark.skipif(
    shutil.which("git") is None or not (ROOT / ".git").exists(), reason="needs git and a checkout"
)


@pytest.fixture
def fast_compiler(tmp_path: Path) -> Path:
    """A compiler that takes a third of the usual time, since it does not optimize."""
    script = tmp_path / "compiler"
    script.write_text('#!/bin/sh\nexec cc "$@" -O0\n')
    script.chmod(0o755)
    return script


@checkout
def test_the_last_commit_is_built_and_measured(tmp_path: Path, fast_compiler: Path) -> None:
    file = tmp_path / "figures.json"
    command = ("-m", "benchmarks", "--quick", "--against", "HEAD", "--only", "hyperneat", "--json", file)
    finished = python(*command, directory=ROOT, CC=str(fast_compiler))
    assert finished.returncode == 0, finished.stdout + finished.stderr
    document = json.loads(file.read_text(encoding="utf-8"))
    assert document["machine"]["this"].startswith(document["machine"]["other"])  # which may have no changes
    [table] = document["sections"]["hyperneat"]["tables"].values()
    assert [row["case"] for row in table] == ["HyperNEAT alone"]
    assert table[0]["times as fast"] > 1.0  # than without optimization


@checkout
def test_an_unknown_revision_fails_by_name(tmp_path: Path) -> None:
    file = tmp_path / "figures.json"
    finished = python("-m", "benchmarks", "--against", "no-such-revision", "--json", file, directory=ROOT)
    assert finished.returncode == 1
    assert "--against failed: 'no-such-revision' is not a commit" in finished.stdout
    failed = json.loads(file.read_text(encoding="utf-8"))["failed"]
    assert list(failed) == ["--against"]


@pytest.mark.parametrize(
    ("options", "expected"), [((), "kernels"), (("--against", "HEAD"), "evolved, published")]
)
def test_an_unknown_name_is_refused_with_the_known_ones(options: tuple[str, ...], expected: str) -> None:
    finished = python("-m", "benchmarks", *options, "--only", "nothing", directory=ROOT)
    assert finished.returncode == 2
    assert "'nothing' is not one of" in " ".join(finished.stderr.split())
    assert expected in " ".join(finished.stderr.split())
