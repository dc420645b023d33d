"""Tests of the protocols: only components with all members are recognized."""

from __future__ import annotations

import inspect
from typing import Any

import numpy as np
import pytest
import toy_capabilities
import toys

import evoframe
from evoframe.contract import protocols

COMPONENTS: dict[str, Any] = {
    "Aggregator": toys.Mean(),
    "CollaborationRun": evoframe.started(toys.First(), "a", "b"),
    "CollaborationStrategy": toys.First(),
    "Credit": toys.Share(),
    "Encoder": toys.Number(),
    "Evolver": toys.Drift(),
    "EvolverRun": toys.Drift().start(1, 1, 4, np.random.default_rng(0)),
    "Executor": toys.Here(),
    "ExecutorRun": toys.Here().start(),
    "Objective": toys.Value(),
    "RoleProvider": toy_capabilities.Constant(),
    "RoleRun": toy_capabilities.Constant().start(toys.Product()),
    "Simulator": toys.Product(),
}


def members_of(protocol: type[Any]) -> set[str]:
    return {name for name in vars(protocol) if not name.startswith("_")}


def test_each_protocol_has_an_example() -> None:
    assert {*COMPONENTS, "Network"} == set(protocols.__all__)


@pytest.mark.parametrize("name", COMPONENTS)
def test_a_protocol_requires_all_its_members(name: str) -> None:
    protocol = getattr(protocols, name)
    assert isinstance(COMPONENTS[name], protocol)
    for missing in members_of(protocol):
        others = dict.fromkeys(members_of(protocol) - {missing}, 1)
        assert not isinstance(type("Component", (), others)(), protocol), missing


@pytest.mark.parametrize("name", COMPONENTS)
def test_a_protocol_is_public_and_documents_each_member(name: str) -> None:
    protocol = getattr(evoframe, name)
    assert protocol is getattr(protocols, name)
    for member in members_of(protocol):
        assert inspect.getdoc(vars(protocol)[member]), member


def test_kinds_of_components_are_distinguished() -> None:
    kinds = {"Aggregator", "CollaborationStrategy", "Encoder", "Evolver", "Objective", "Simulator"}
    for kind in kinds:
        kept = {other for other in kinds if isinstance(COMPONENTS[kind], getattr(protocols, other))}
        assert kept == {kind}
