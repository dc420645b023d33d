"""The registry: what is offered, what is refused, and how names are found."""

from __future__ import annotations

import sys
import types
from collections.abc import Callable
from pathlib import Path
from typing import Any

import attrs
import pytest
import toys
from modules import plugin

from evoframe import ConfigurationError, PluginError, PluginWarning, RunConfig, hookimpl
from evoframe.contract.config import Source
from evoframe.registry.discovery import discover
from evoframe.registry.observers import Observers
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


@attrs.define
class Changeable:
    domain = (-1e100, 1e100)

    def check(self, n: int) -> None:
        pass

    def aggregate(self, scores: Any) -> float:
        return 0.0


@attrs.frozen
class Unfinished:
    domain = (-1e100, 1e100)

    def aggregate(self, scores: Any) -> float:
        return 0.0


class TestComponentsOfOthers:
    @pytest.mark.parametrize(
        ("component", "message"),
        [
            (Changeable, "aggregator 'mine' of plugin 'main' of here 1.0 is no frozen attrs class"),
            (Unfinished, "aggregator 'mine' of plugin 'main' of here 1.0 has no check"),
        ],
    )
    def test_are_held_to_their_protocol_when_they_are_chosen(
        self, toy_plugins: Plugins, toy_config: Callable[..., RunConfig], component: type[Any], message: str
    ) -> None:
        toy_plugins.add(plugin(evoframe_aggregators=lambda: {"mine": component}), HERE)
        toy_config()  # as long as nobody asks for it, all is well
        with pytest.raises(ConfigurationError, match=f"--set aggregator=mine: aggregator: {message}"):
            toy_config("aggregator=mine")


class TestLocalModules:
    MODULE = """
import attrs
from evoframe import hookimpl

@attrs.frozen
class Highest:
    domain = (-1e100, 1e100)
    def check(self, n): pass
    def aggregate(self, scores): return float(max(scores))

@hookimpl
def evoframe_aggregators():
    return {"highest": Highest}
"""

    def test_a_file_is_a_plugin(self, tmp_path: Path) -> None:
        path = tmp_path / "highest_of_all.py"
        path.write_text(self.MODULE)
        offer = discover([str(path)]).find("aggregator", "highest")
        assert str(offer.source) == "'highest_of_all' of highest_of_all local"

    def test_a_module_beside_the_user_is_a_plugin(
        self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        (tmp_path / "highest_beside.py").write_text(self.MODULE)
        monkeypatch.chdir(tmp_path)
        monkeypatch.setattr(sys, "path", [*sys.path])
        assert discover(["highest_beside"]).names("aggregator") == ["am", "gm", "highest", "hm", "wm"]

    @pytest.mark.parametrize(
        ("text", "cause"),
        [("1 / 0", "ZeroDivisionError"), ("x = 1", "implements no hook"), ("(", "SyntaxError")],
    )
    def test_one_that_fails_is_an_error(self, tmp_path: Path, text: str, cause: str) -> None:
        path = tmp_path / "bad_local.py"
        path.write_text(text)
        with pytest.raises(PluginError, match=cause):
            discover([str(path)])

    def test_one_with_the_name_of_a_module_of_python_replaces_it_for_nobody(self, tmp_path: Path) -> None:
        path = tmp_path / "random.py"
        path.write_text(self.MODULE)
        assert "highest" in discover([str(path), str(path)]).names("aggregator")
        assert hasattr(sys.modules["random"], "SystemRandom")

    def test_one_that_does_not_exist_is_an_error(self) -> None:
        with pytest.raises(PluginError, match="no such file"):
            discover(["nowhere.py"])
        with pytest.raises(PluginError, match="No module named 'nowhere_at_all'"):
            discover(["nowhere_at_all"])


class TestObservers:
    @pytest.mark.parametrize("error", [RuntimeError("no disk"), SystemExit("no disk")])
    def test_each_is_told_and_one_that_raises_is_disabled_with_a_warning(self, error: BaseException) -> None:
        told: list[str] = []

        def fails(turn: Any) -> None:
            told.append("fails")
            raise error

        plugins = Plugins()
        plugins.add(plugin(evoframe_turn_finished=lambda turn: told.append("first")), Source("a", "1", "x"))
        plugins.add(plugin(evoframe_turn_finished=fails), Source("b", "1", "x"))
        plugins.add(plugin(evoframe_turn_finished=lambda: told.append("last")), Source("c", "1", "x"))
        observers = Observers(plugins.manager)
        with pytest.warns(PluginWarning, match="observer 'b:x' is disabled: .*: no disk"):
            observers.tell("evoframe_turn_finished", turn=None)
        assert sorted(told) == ["fails", "first", "last"]
        observers.tell("evoframe_turn_finished", turn=None)
        assert told.count("fails") == 1
        assert told.count("first") == told.count("last") == 2
