"""Tests of the removal of outdated files of an earlier report."""

from __future__ import annotations

from pathlib import Path

import pytest

from evoframe.analysis.output.listing import LIST_FILE, Listing, announce, listed, refuse_overwriting, settle
from evoframe.errors import InputError


def written(directory: Path, *names: str) -> list[Path]:
    paths = [directory / name for name in names]
    for path in paths:
        path.write_text(path.name)
    return paths


def names(directory: Path) -> set[str]:
    return {path.name for path in directory.iterdir()}


def renewed(directory: Path, *names: str, of: str = "run") -> None:
    settle(directory, of, listed(directory), written(directory, *names))


def test_outdated_files_are_removed(tmp_path: Path) -> None:
    assert listed(tmp_path) == Listing()
    written(tmp_path, "mine")
    renewed(tmp_path, "a", "b")
    assert (listed(tmp_path).of, set(listed(tmp_path).files)) == ("run", {"a", "b"})
    renewed(tmp_path, "b", "c", of="another")
    assert names(tmp_path) == {"mine", "b", "c", LIST_FILE}
    assert (listed(tmp_path).of, set(listed(tmp_path).files)) == ("another", {"b", "c"})


def test_modified_removed_and_linked_files_are_kept(tmp_path: Path) -> None:
    renewed(tmp_path, "changed", "removed", "linked")
    (tmp_path / "changed").write_text("by somebody")
    (tmp_path / "removed").unlink()
    (tmp_path / "linked").rename(tmp_path / "elsewhere")
    (tmp_path / "linked").symlink_to(tmp_path / "elsewhere")
    renewed(tmp_path, "new")
    assert names(tmp_path) == {"changed", "linked", "elsewhere", "new", LIST_FILE}


class TestOverwriting:
    def test_of_files_of_the_earlier_report_is_allowed(self, tmp_path: Path) -> None:
        renewed(tmp_path, "a", "b")
        refuse_overwriting(tmp_path, {"a": b"new", "b": b"new", "c": b"new"}, listed(tmp_path))

    def test_by_the_same_content_is_allowed(self, tmp_path: Path) -> None:
        written(tmp_path, "a")
        refuse_overwriting(tmp_path, {"a": b"a"}, Listing())

    @pytest.mark.parametrize("by", ["elsewhere", "modified", "directory"])
    def test_of_anything_else_is_refused(self, tmp_path: Path, by: str) -> None:
        path = tmp_path / "a"
        if by == "directory":
            path.mkdir()
        elif by == "modified":
            renewed(tmp_path, "a")
        if by != "directory":
            path.write_text("by somebody")
        with pytest.raises(InputError) as caught:
            refuse_overwriting(tmp_path, {"a": b"new"}, listed(tmp_path))
        assert caught.value.source == str(path)
        assert "--force" in caught.value.problem

    def test_after_an_interruption_is_allowed(self, tmp_path: Path) -> None:
        """Each file has its content before or after; both were written by evoframe."""
        renewed(tmp_path, "a", "b", "c")
        for content in (b"second", b"third"):
            files = {"a": content, "b": content, "d": content}
            refuse_overwriting(tmp_path, files, listed(tmp_path))
            announce(tmp_path, "run", files, listed(tmp_path))
            (tmp_path / "a").write_bytes(content)  # then it is interrupted
        refuse_overwriting(tmp_path, {"a": b"4", "b": b"4"}, listed(tmp_path))
        renewed(tmp_path, "a")
        assert names(tmp_path) == {"a", LIST_FILE}


@pytest.mark.parametrize(
    "text",
    [
        *("", "[]", "{}", "[" * 100_000, '{"files": ["a"]}', '{"files": {}, "earlier": {"a": 1}}'),
        *(f'{{"files": {{"{name}": ""}}}}' for name in ("", "..", "../a", "/a", "a\\u0000")),
    ],
)
def test_a_file_that_is_not_a_list_of_a_report_is_rejected(tmp_path: Path, text: str) -> None:
    (tmp_path / LIST_FILE).write_text(text)
    with pytest.raises(InputError) as caught:
        listed(tmp_path)
    assert caught.value.source == str(tmp_path / LIST_FILE)
    assert "--out" in caught.value.problem
