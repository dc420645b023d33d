"""Distributions of other people, really installed by pip into a temporary place."""

from __future__ import annotations

import functools
import json
import shutil
from pathlib import Path

import pytest
from processes import Evoframe, python

SOURCES = Path(__file__).parents[1] / "third_party"


def install(name: str, target: Path) -> None:
    source = target.parent / f"source-{name}"
    shutil.copytree(SOURCES / name, source)  # building leaves files behind
    options = ["--quiet", "--no-deps", "--no-build-isolation", "--no-index", "--target", str(target)]
    installed = python("-m", "pip", "install", *options, source)
    assert installed.returncode == 0, installed.stderr


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    target = tmp_path_factory.mktemp("third-party") / "site"
    for name in ("median", "broken"):
        install(name, target)
    return target


@pytest.fixture
def evoframe(site: Path, tmp_path: Path) -> Evoframe:
    return functools.partial(python, "-m", "evoframe", directory=tmp_path, PYTHONPATH=str(site))


def test_an_aggregator_is_selected_by_name(evoframe: Evoframe, tmp_path: Path) -> None:
    finished = evoframe(
        "run", "quick", "--set", "aggregator=median", "--set", "run.generations=1", "--out", "here"
    )
    assert finished.returncode == 0, finished.stderr
    config = tmp_path.joinpath("here", "config.toml").read_text()
    assert '[aggregator]\nname = "median"' in config
    assert "aggregator = \"'median' of acme-median 2.1\"" in config


def test_one_that_fails_to_import_is_skipped_with_a_warning_and_the_run_goes_on(evoframe: Evoframe) -> None:
    finished = evoframe("run", "quick", "--set", "run.generations=0", "--out", "there")
    assert finished.returncode == 0
    [warning] = [line for line in finished.stderr.splitlines() if "acme-broken" in line]
    assert warning == (
        "Warning: plugin 'broken' of acme-broken 0.3 is skipped: "
        "ModuleNotFoundError: No module named 'a_module_that_nobody_has'"
    )


def test_the_list_of_plugins_shows_both(evoframe: Evoframe) -> None:
    listed = json.loads(evoframe("plugins", "list", "--json").stdout)
    assert {"median"} == {c["name"] for c in listed["components"] if c["distribution"] == "acme-median"}
    assert [skipped["distribution"] for skipped in listed["skipped"]] == ["acme-broken"]
    assert "acme-broken 0.3" in evoframe("plugins", "list").stdout


def test_asking_for_what_was_skipped_names_the_cause(evoframe: Evoframe) -> None:
    finished = evoframe("config", "show", "--set", "aggregator=trimmed")
    assert finished.returncode == 2
    assert "unknown aggregator 'trimmed'" in finished.stderr
    assert "acme-broken 0.3: ModuleNotFoundError" in finished.stderr


def test_the_environment_blocks_and_requires_distributions(evoframe: Evoframe) -> None:
    blocked = evoframe(
        "config", "show", "--set", "aggregator=median", EVOFRAME_PLUGINS_BLOCK="acme-median,acme-broken"
    )
    assert blocked.returncode == 2
    assert "unknown aggregator 'median'" in blocked.stderr
    assert "acme-broken" not in blocked.stderr
    required = evoframe("plugins", "list", EVOFRAME_PLUGINS_REQUIRE="acme-broken")
    assert required.returncode == 2
    assert "required plugin 'acme-broken' cannot be used: ModuleNotFoundError" in required.stderr


def test_the_configuration_blocks_and_requires_distributions(evoframe: Evoframe) -> None:
    blocked = evoframe(
        "config", "show", "--set", "aggregator=median", "--set", 'plugins.block=["acme-median"]'
    )
    assert (blocked.returncode, "unknown aggregator 'median'" in blocked.stderr) == (2, True)
    required = evoframe("config", "show", "--set", 'plugins.require=["acme-nothing"]')
    assert (required.returncode, "'acme-nothing' is not installed" in required.stderr) == (2, True)
