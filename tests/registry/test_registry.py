"""The registry: what is offered, what is refused, and how names are found."""

from __future__ import annotations

import types
from typing import Any

import pytest
import toys
from modules import plugin

from evoframe import ConfigurationError, PluginError, hookimpl
from evoframe.contract.config import Source
from evoframe.registry.registry import Plugins

HERE = Source("here", "1.0", "main")


class TestRegistry:
    def test_a_name_finds_its_component(self, toy_plugins: Plugins) -> None:
        offer = toy_plugins.find("aggregator", "toy-mean")
        assert (offer.component, offer.source.distribution) == (toys.Mean, "toy-box")

    def test_an_unknown_name_is_answered_with_those_that_exist(self, toy_plugins: Plugins) -> None:
        with pytest.raises(ConfigurationError) as caught:
            toy_plugins.find("aggregator", "toy-men")
        assert (
            str(caught.value) == "unknown aggregator 'toy-men'; did you mean 'toy-mean'? installed: toy-mean"
        )

    def test_two_of_one_name_are_an_error_only_when_asked_for(self, toy_plugins: Plugins) -> None:
        toy_plugins.add(plugin(evoframe_aggregators=lambda: {"toy-mean": toys.Mean}), HERE)
        with pytest.raises(
            ConfigurationError, match="several plugins; write 'toy-box:toy-mean' or 'here:toy-mean'"
        ):
            toy_plugins.find("aggregator", "toy-mean")
        assert toy_plugins.find("aggregator", "here:toy-mean").source == HERE
        assert toy_plugins.find("simulator", "toy-product").component is toys.Product

    @pytest.mark.parametrize(
        ("functions", "message"),
        [
            (
                {"evoframe_agregators": lambda: {"x": toys.Mean}},
                "unknown hook 'evoframe_agregators'; did you mean 'evoframe_aggreg",
            ),
            ({"evoframe_aggregators": lambda: [toys.Mean]}, "must return a mapping of names to classes"),
            ({"evoframe_aggregators": lambda: {"x": 3}}, "offers 'x': 3, which is no attrs class"),
            (
                {"evoframe_aggregators": lambda: {"a:b": toys.Mean}},
                "offers the name 'a:b'; use lower-case letters",
            ),
            ({"evoframe_aggregators": lambda: {"": toys.Mean}}, "offers the name ''; use lower-case letters"),
            ({"evoframe_turn_finished": lambda trun: None}, "trun"),
            ({}, "implements no hook"),
        ],
    )
    def test_what_is_no_plugin_is_refused_as_a_whole(
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

    def test_the_same_plugin_twice_is_refused_in_a_sentence(self, toy_plugins: Plugins) -> None:
        with pytest.raises(PluginError, match=r"^there is a plugin of that name already$"):
            toy_plugins.add(toys, Source("toy-box", "1.0", "toys"))

    def test_names_of_distributions_are_compared_as_packaging_does(self, toy_plugins: Plugins) -> None:
        toy_plugins.require(["Toy_Box"])
        assert toy_plugins.find("aggregator", "TOY.BOX:toy-mean").component is toys.Mean
        assert toy_plugins.without(["toy.box"]).names("aggregator") == []

    def test_blocked_distributions_are_left_out(self, toy_plugins: Plugins) -> None:
        assert toy_plugins.without(["toy-box"]).names("aggregator") == []
        assert toy_plugins.without(["other"]).names("aggregator") == ["toy-mean"]
