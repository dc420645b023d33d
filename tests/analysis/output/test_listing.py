"""Tests of the removal of outdated files of an earlier report."""

from __future__ import annotations

from pathlib import Path

import pytest

from evoframe.analysis.output.listing import LIST_FILE, listed, settle
from evoframe.errors import InputError


def written(directory: Path, *names: str) -> list[Path]:
    paths = [directory / name for name in names]
    for path in paths:
        path.write_text(path.name)
    return paths


def names(directory: Path) -> set[str]:
    return {path.name for path in directory.iterdir()}


def test_outdated_files_are_removed(tmp_path: Path) -> None:
    assert listed(tmp_path) == {}
    written(tmp_path, "mine")
    settle(tmp_path, listed(tmp_path), written(tmp_path, "a", "b"))
    assert set(listed(tmp_path)) == {"a", "b"}
    settle(tmp_path, listed(tmp_path), written(tmp_path, "b", "c"))
    assert names(tmp_path) == {"mine", "b", "c", LIST_FILE}
    assert set(listed(tmp_path)) == {"b", "c"}


def test_modified_removed_and_linked_files_are_kept(tmp_path: Path) -> None:
    settle(tmp_path, {}, written(tmp_path, "changed", "removed", "linked"))
    (tmp_path / "changed").write_text("by somebody")
    (tmp_path / "removed").unlink()
    (tmp_path / "linked").rename(tmp_path / "elsewhere")
    (tmp_path / "linked").symlink_to(tmp_path / "elsewhere")
    settle(tmp_path, listed(tmp_path), written(tmp_path, "new"))
    assert names(tmp_path) == {"changed", "linked", "elsewhere", "new", LIST_FILE}


@pytest.mark.parametrize(
    "text",
    [
        *("", "[]", "{}", "[" * 100_000, '{"files": ["a"]}'),
        *(f'{{"files": {{"{name}": ""}}}}' for name in ("", "..", "../a", "/a", "a\\u0000")),
    ],
)
def test_a_file_that_is_not_a_list_of_a_report_is_rejected(tmp_path: Path, text: str) -> None:
    (tmp_path / LIST_FILE).write_text(text)
    with pytest.raises(InputError) as caught:
        listed(tmp_path)
    assert caught.value.source == str(tmp_path / LIST_FILE)
    assert "--out" in caught.value.problem
