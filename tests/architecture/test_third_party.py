"""Tests of third-party distributions, installed by pip into a temporary directory."""

from __future__ import annotations

import functools
import json
from pathlib import Path

import pytest
from processes import Evoframe, python
from third_parties import installed


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return installed(tmp_path_factory.mktemp("third-party"), "median", "broken")


@pytest.fixture
def evoframe(site: Path, tmp_path: Path) -> Evoframe:
    return functools.partial(python, "-m", "evoframe", directory=tmp_path, PYTHONPATH=str(site))


def test_an_aggregator_is_selected_by_name(evoframe: Evoframe, tmp_path: Path) -> None:
    finished = evoframe(
        "run", "quick", "--set", "aggregator=middle", "--set", "run.generations=1", "--out", "here"
    )
    assert finished.returncode == 0, finished.stderr
    config = tmp_path.joinpath("here", "config.toml").read_text()
    assert '[aggregator]\nname = "middle"' in config
    assert "aggregator = \"'median' of acme-median 2.1\"" in config


def test_a_plugin_that_fails_to_import_is_skipped_with_a_warning(evoframe: Evoframe) -> None:
    finished = evoframe("run", "quick", "--set", "run.generations=0", "--out", "there")
    assert finished.returncode == 0
    [warning] = [line for line in finished.stderr.splitlines() if "acme-broken" in line]
    parts = ("Warning", "'broken' of acme-broken 0.3", "ModuleNotFoundError", "'a_module_that_nobody_has'")
    assert all(part in warning for part in parts)


def test_the_list_of_plugins_shows_both(evoframe: Evoframe) -> None:
    listed = json.loads(evoframe("plugins", "list", "--json").stdout)
    assert {"middle"} == {c["name"] for c in listed["components"] if c["distribution"] == "acme-median"}
    assert [skipped["distribution"] for skipped in listed["skipped"]] == ["acme-broken"]
    assert "acme-broken 0.3" in evoframe("plugins", "list").stdout


def test_an_unknown_name_is_answered_with_skipped_plugins(evoframe: Evoframe) -> None:
    finished = evoframe("config", "show", "--set", "aggregator=trimmed")
    assert finished.returncode == 2
    parts = ("aggregator", "'trimmed'", "acme-broken 0.3", "ModuleNotFoundError")
    assert all(part in finished.stderr for part in parts)


def test_the_environment_blocks_and_requires_distributions(evoframe: Evoframe) -> None:
    blocked = evoframe(
        "config", "show", "--set", "aggregator=middle", EVOFRAME_PLUGINS_BLOCK="acme-median,acme-broken"
    )
    assert blocked.returncode == 2
    assert "'middle'" in blocked.stderr
    assert "acme-broken" not in blocked.stderr
    required = evoframe("plugins", "list", EVOFRAME_PLUGINS_REQUIRE="acme-broken")
    assert required.returncode == 2
    assert all(part in required.stderr for part in ("'acme-broken'", "ModuleNotFoundError"))


def test_the_configuration_blocks_and_requires_distributions(evoframe: Evoframe) -> None:
    blocked = evoframe(
        "config", "show", "--set", "aggregator=middle", "--set", 'plugins.block=["acme-median"]'
    )
    assert (blocked.returncode, "'middle'" in blocked.stderr) == (2, True)
    required = evoframe("config", "show", "--set", 'plugins.require=["acme-nothing"]')
    assert (required.returncode, "'acme-nothing'" in required.stderr) == (2, True)
    assert "plugins.require" in required.stderr
