"""``evoframe plugins``; plugins of others are in ``tests/architecture/test_third_party.py``."""

from __future__ import annotations

import json

import toys
from processes import Evoframe

from evoframe import __version__


def test_list_names_every_component_with_its_plugin(evoframe: Evoframe) -> None:
    listed = json.loads(evoframe("plugins", "list", "--json", "-p", toys.__file__).stdout)
    assert listed["skipped"] == []
    components = {(each["kind"], each["name"]): each for each in listed["components"]}
    assert list(components) == sorted(components)
    assert components["aggregator", "wm"]["version"] == __version__
    assert components["aggregator", "wm"]["class"].startswith("evoframe_aggregators.")
    assert components["simulator", "toy-product"]["distribution"] == "toys"


def test_list_says_in_a_line_what_each_is(evoframe: Evoframe) -> None:
    header, *lines = evoframe("plugins", "list").stdout.splitlines()
    assert header.split() == ["setting", "name", "description", "distribution", "version"]
    [line] = [line for line in lines if line.split()[:2] == ["simulator", "vox"]]
    assert line.split()[-2:] == ["evoframe", __version__]
    assert len(line.split()) > 4
