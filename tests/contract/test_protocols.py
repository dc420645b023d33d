"""The protocols: who keeps them is recognised, and who does not is not."""

from __future__ import annotations

import inspect
from typing import Any

import numpy as np
import pytest
import toys

import evoframe
from evoframe.contract import protocols

COMPONENTS: dict[str, Any] = {
    "Aggregator": toys.Mean(),
    "CollaborationStrategy": toys.First(),
    "Encoder": toys.Number(),
    "Evolver": toys.Drift(),
    "EvolverRun": toys.Drift().start(1, 1, 4, np.random.default_rng(0)),
    "Executor": toys.Here(),
    "ExecutorRun": toys.Here().start(),
    "Objective": toys.Value(),
    "Simulator": toys.Product(),
}


def members_of(protocol: type[Any]) -> set[str]:
    return {name for name in vars(protocol) if not name.startswith("_")}


def test_there_is_an_example_of_each() -> None:
    assert {*COMPONENTS, "Network"} == set(protocols.__all__)


@pytest.mark.parametrize("name", COMPONENTS)
def test_who_has_all_members_keeps_a_protocol_and_nobody_else(name: str) -> None:
    protocol = getattr(protocols, name)
    assert isinstance(COMPONENTS[name], protocol)
    for missing in members_of(protocol):
        others = dict.fromkeys(members_of(protocol) - {missing}, 1)
        assert not isinstance(type("Component", (), others)(), protocol), missing


@pytest.mark.parametrize("name", COMPONENTS)
def test_a_protocol_says_what_each_member_is_for_and_is_public(name: str) -> None:
    protocol = getattr(evoframe, name)
    assert protocol is getattr(protocols, name)
    for member in members_of(protocol):
        assert inspect.getdoc(vars(protocol)[member]), member


def test_kinds_of_components_are_told_apart() -> None:
    kinds = {"Aggregator", "CollaborationStrategy", "Encoder", "Evolver", "Objective", "Simulator"}
    for kind in kinds:
        kept = {other for other in kinds if isinstance(COMPONENTS[kind], getattr(protocols, other))}
        assert kept == {kind}
