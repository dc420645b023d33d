"""Tests of observers: each is called, and none stops a run."""

from __future__ import annotations

from typing import Any

import pytest
from modules import plugin

from evoframe import PluginWarning
from evoframe.contract.config import Source
from evoframe.registry.observers import Observers
from evoframe.registry.registry import Plugins


class TestObservers:
    @pytest.mark.parametrize("error", [RuntimeError("no disk"), SystemExit("no disk")])
    def test_each_is_called_and_one_that_raises_is_disabled_with_a_warning(
        self, error: BaseException
    ) -> None:
        called: list[str] = []

        def fails(turn: Any) -> None:
            called.append("fails")
            raise error

        plugins = Plugins()
        plugins.add(plugin(evoframe_turn_finished=lambda turn: called.append("first")), Source("a", "1", "x"))
        plugins.add(plugin(evoframe_turn_finished=fails), Source("b", "1", "x"))
        plugins.add(plugin(evoframe_turn_finished=lambda: called.append("last")), Source("c", "1", "x"))
        observers = Observers(plugins.manager)
        with pytest.warns(PluginWarning, match="'b:x'.*no disk"):
            observers.tell("evoframe_turn_finished", turn=None)
        assert sorted(called) == ["fails", "first", "last"]
        observers.tell("evoframe_turn_finished", turn=None)
        assert called.count("fails") == 1
        assert called.count("first") == called.count("last") == 2
