"""``evoframe doctor``."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import toys
from processes import Evoframe

import evoframe_libvox
from evoframe import __version__


def test_an_installation_that_is_in_order(evoframe: Evoframe) -> None:
    found = evoframe("doctor")
    assert found.returncode == 0, found.stderr
    for part in (
        f"numpy {np.__version__}",
        f"libvox kernel {evoframe_libvox.KERNELS[-1]}",
        f"libvox compiler {evoframe_libvox.COMPILER}",
        "simulations in",
        f"evoframe {__version__}",
    ):
        assert part in found.stdout


def test_a_plugin_that_is_missing_is_a_problem(evoframe: Evoframe) -> None:
    found = evoframe("doctor", EVOFRAME_PLUGINS_BLOCK="evoframe")
    assert found.returncode == 1
    assert "problem" in found.stdout
    assert "0 components" in found.stdout


def test_a_run_and_its_champion(evoframe: Evoframe, tmp_path: Path) -> None:
    (tmp_path / "toy.toml").write_text(toys.CONFIGURATION)
    assert evoframe("run", "-p", toys.__file__, "toy.toml", "--out", "here").returncode == 0
    sound = evoframe("doctor", "-p", toys.__file__, "here", "--json")
    assert sound.returncode == 0, sound.stdout
    assert {check["state"] for check in json.loads(sound.stdout)["here"]} == {"ok"}
    (tmp_path / "here" / "champion.json").unlink()
    found = evoframe("doctor", "-p", toys.__file__, "here")
    assert found.returncode == 1
    assert "here/champion.json: " in found.stdout
    assert "evoframe resume here" in found.stdout


def test_what_is_no_run_does_not_hide_the_others(evoframe: Evoframe) -> None:
    assert evoframe("run", "quick", "--set", "run.generations=0", "--out", "here").returncode == 0
    found = evoframe("doctor", "nowhere", "here", "--json")
    assert found.returncode == 2
    checks = json.loads(found.stdout)
    [check] = checks["nowhere"]
    assert (check["subject"], check["state"]) == ("directory", "problem")
    assert check["finding"].startswith("nowhere: ")
    assert {check["state"] for check in checks["here"]} == {"ok"}
