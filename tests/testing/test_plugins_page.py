"""The examples of ``docs/plugins.md`` work as the page describes."""

import re
import tomllib
from pathlib import Path

import pytest
from processes import python

import evoframe
from evoframe import testing
from evoframe.registry import hookspecs

PAGE = (Path(__file__).parents[2] / "docs" / "plugins.md").read_text(encoding="utf-8")
PLUGIN, TESTS, OBSERVER = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
TABLES = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)


def test_the_plugin_passes_its_contract_tests(tmp_path: Path) -> None:
    (tmp_path / "evoframe_trimmed.py").write_text(PLUGIN)
    (tmp_path / "test_trimmed.py").write_text(TESTS)
    ended = python("-m", "pytest", "-q", "-W", "error", "-p", "no:cacheprovider", tmp_path)
    assert ended.returncode == 0, ended.stdout
    assert " passed" in ended.stdout


def test_the_observer_is_python_of_the_public_api() -> None:
    names: dict[str, object] = {}
    exec(compile(OBSERVER, "observer", "exec"), names)  # noqa: S102 - the page's own code
    assert callable(names["evoframe_turn_finished"])


@pytest.mark.parametrize("table", TABLES)
def test_the_tables_are_toml(table: str) -> None:
    assert tomllib.loads(table)


def test_the_entry_point_is_in_the_group() -> None:
    [project] = [tables for tables in map(tomllib.loads, TABLES) if "project" in tables]
    assert project["project"]["entry-points"]["evoframe"] == {"trimmed": "evoframe_trimmed"}
    assert project["tool"]["setuptools"]["py-modules"] == ["evoframe_trimmed"]


def test_the_page_names_every_hook_protocol_and_contract() -> None:
    hooks = [name for name in vars(hookspecs) if name.startswith("evoframe_")]
    protocols = [name.removesuffix("Contract") for name in testing.__all__]
    assert set(protocols) <= set(evoframe.__all__)
    for name in [*hooks, *protocols, *testing.__all__]:
        assert f"`{name}" in PAGE, name


@pytest.mark.parametrize("name", [name for name in evoframe.__all__ if name.startswith("Supports")])
def test_the_page_names_every_optional_capability_with_its_members(name: str) -> None:
    [row] = [line for line in PAGE.splitlines() if line.startswith("|") and f"`{name}`" in line]
    own = [member for member in vars(getattr(evoframe, name)) if not member.startswith("_")]
    assert own
    assert all(f"`{member}" in row for member in own)
