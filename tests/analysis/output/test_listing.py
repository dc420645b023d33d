"""A report removes what an earlier one has left, and nothing else."""

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


def test_what_is_not_written_again_is_removed(tmp_path: Path) -> None:
    assert listed(tmp_path) == {}
    written(tmp_path, "mine")
    settle(tmp_path, listed(tmp_path), written(tmp_path, "a", "b"))
    assert set(listed(tmp_path)) == {"a", "b"}
    settle(tmp_path, listed(tmp_path), written(tmp_path, "b", "c"))
    assert names(tmp_path) == {"mine", "b", "c", LIST_FILE}
    assert set(listed(tmp_path)) == {"b", "c"}


def test_what_somebody_has_changed_removed_or_linked_is_left_alone(tmp_path: Path) -> None:
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
def test_a_list_of_something_else_is_refused(tmp_path: Path, text: str) -> None:
    (tmp_path / LIST_FILE).write_text(text)
    with pytest.raises(InputError, match="is no list of a report's files"):
        listed(tmp_path)
