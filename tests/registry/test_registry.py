"""Tests of the registry: components on offer, invalid plugins, and the lookup of names."""

from __future__ import annotations

import types
from typing import Any

import pytest
import toys
from modules import plugin

from evoframe import ConfigurationError, PluginError, hookimpl
from evoframe.contract import Aggregator, Credit, RoleProvider, RoleRun
from evoframe.contract.config import Source
from evoframe.registry.registry import KINDS, Plugins, kind_of

HERE = Source("here", "1.0", "main")


class TestRegistry:
    def test_a_name_finds_its_component(self, toy_plugins: Plugins) -> None:
        offer = toy_plugins.find("aggregator", "toy-mean")
        assert (offer.component, offer.source.distribution) == (toys.Mean, "toy-box")

    def test_an_unknown_name_is_answered_with_the_known_ones(self, toy_plugins: Plugins) -> None:
        with pytest.raises(ConfigurationError) as caught:
            toy_plugins.find("aggregator", "toy-men")
        parts = ("aggregator", "'toy-men'", "'toy-mean'", "installed: toy-mean")
        assert all(part in caught.value.problem for part in parts)

    @pytest.mark.parametrize(
        ("kind", "name", "meant"),
        [
            ("aggregator", "toy-last", "collaboration=toy-last"),
            ("strategy", "toy-mean", "aggregator=toy-mean"),
            ("simulator", "toy-drift", "populations.ROLE.evolver=toy-drift"),
            ("strategy", "toy-random", "roles.NAME.provider=toy-random"),
        ],
    )
    def test_a_name_of_another_kind_is_answered_with_its_key(
        self, toy_plugins: Plugins, kind: str, name: str, meant: str
    ) -> None:
        with pytest.raises(ConfigurationError) as caught:
            toy_plugins.find(kind, name)
        assert f"'{meant}'" in caught.value.problem
        assert all(each in caught.value.problem for each in toy_plugins.names(kind))

    def test_the_kinds_of_a_name_are_sorted(self, toy_plugins: Plugins) -> None:
        toy_plugins.add(plugin(evoframe_encoders=lambda: {"toy-mean": toys.Number}), HERE)
        assert toy_plugins.kinds_of("toy-mean") == ["aggregator", "encoder"]
        assert toy_plugins.kinds_of("toy") == []

    def test_two_of_one_name_are_an_error_only_when_looked_up(self, toy_plugins: Plugins) -> None:
        toy_plugins.add(plugin(evoframe_aggregators=lambda: {"toy-mean": toys.Mean}), HERE)
        with pytest.raises(ConfigurationError, match="'toy-box:toy-mean' or 'here:toy-mean'"):
            toy_plugins.find("aggregator", "toy-mean")
        assert toy_plugins.find("aggregator", "here:toy-mean").source == HERE
        assert toy_plugins.find("simulator", "toy-product").component is toys.Product

    @pytest.mark.parametrize(
        ("functions", "message"),
        [
            (
                {"evoframe_agregators": lambda: {"x": toys.Mean}},
                "'evoframe_agregators'.*'evoframe_aggregators'",
            ),
            ({"evoframe_aggregators": lambda: [toys.Mean]}, "evoframe_aggregators .*mapping.*Mean"),
            ({"evoframe_aggregators": lambda: {"x": 3}}, "evoframe_aggregators .*'x': 3.*attrs class"),
            ({"evoframe_aggregators": lambda: {"a:b": toys.Mean}}, "evoframe_aggregators .*name 'a:b'"),
            ({"evoframe_aggregators": lambda: {"": toys.Mean}}, "evoframe_aggregators .*name ''"),
            ({"evoframe_turn_finished": lambda trun: None}, "trun"),
            ({}, "hookimpl"),
        ],
    )
    def test_an_invalid_plugin_is_refused_completely(
        self, toy_plugins: Plugins, functions: dict[str, Any], message: str
    ) -> None:
        before = list(toy_plugins.offers)
        bad = plugin(**functions)
        with pytest.raises(PluginError, match=message):
            toy_plugins.add(bad, HERE)
        assert toy_plugins.offers == before
        assert not toy_plugins.manager.is_registered(bad)

    def test_a_function_of_another_name_may_implement_a_hook(self, toy_plugins: Plugins) -> None:
        module = types.ModuleType("plugin")
        vars(module)["offer"] = hookimpl(specname="evoframe_aggregators")(lambda: {"mine": toys.Mean})
        toy_plugins.add(module, HERE)
        assert toy_plugins.find("aggregator", "mine").source == HERE

    def test_a_plugin_is_registered_only_once(self, toy_plugins: Plugins) -> None:
        with pytest.raises(PluginError, match="'toy-box:toys'"):
            toy_plugins.add(toys, Source("toy-box", "1.0", "toys"))

    def test_names_of_distributions_are_compared_as_packaging_does(self, toy_plugins: Plugins) -> None:
        toy_plugins.require(["Toy_Box"])
        assert toy_plugins.find("aggregator", "TOY.BOX:toy-mean").component is toys.Mean
        assert toy_plugins.without(["toy.box"]).names("aggregator") == []

    def test_blocked_distributions_are_left_out(self, toy_plugins: Plugins) -> None:
        assert toy_plugins.without(["toy-box"]).names("aggregator") == []
        assert toy_plugins.without(["other"]).names("aggregator") == ["toy-mean", "toy-share"]


class TestKinds:
    def test_an_aggregator_can_be_a_credit(self) -> None:
        assert KINDS["aggregator"].missing(toys.Mean()) == []
        assert KINDS["aggregator"].missing(toys.Share()) == []
        assert kind_of(Aggregator) == kind_of(Credit) == "aggregator"

    def test_the_lacking_members_are_those_of_the_closest_protocol(self) -> None:
        def having(*members: str) -> object:
            return type("Component", (), dict.fromkeys(members, 1))()

        assert KINDS["aggregator"].missing(having("credit")) == ["check"]
        assert KINDS["aggregator"].missing(having("aggregate", "domain")) == ["check"]
        assert KINDS["role"].missing(having("provides", "requires")) == ["start"]

    def test_a_protocol_that_is_not_offered_has_no_kind(self) -> None:
        assert kind_of(RoleProvider) == "role"
        assert kind_of(RoleRun) is None
        assert kind_of(int) is None
