"""Tests of the hooks: each is documented and versioned as part of the public API."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any

import pluggy
import pytest

from evoframe.registry import KINDS, hookspecs

HOOKS: dict[str, Callable[..., Any]] = {
    name: value for name, value in vars(hookspecs).items() if name.startswith("evoframe_")
}
OBSERVED = {"evoframe_run_started", "evoframe_turn_finished", "evoframe_run_finished", "evoframe_commands"}


def test_each_kind_of_component_has_a_hook_and_the_others_observe() -> None:
    kinds = [kind.hook for kind in KINDS.values()]
    assert len(set(kinds)) == len(kinds)
    assert HOOKS.keys() == {*kinds, *OBSERVED}


@pytest.mark.parametrize("name", HOOKS)
def test_each_documents_its_arguments_and_its_version(name: str) -> None:
    text = inspect.getdoc(HOOKS[name]) or ""
    assert ".. versionadded:: " in text
    parameters = inspect.signature(HOOKS[name]).parameters
    documented = text.partition("Args:")[2].partition("Raises:")[0]
    assert all(f"{parameter}:" in documented or parameter in text.split(".")[0] for parameter in parameters)


@pytest.mark.parametrize("kind", KINDS)
def test_a_hook_of_components_returns_a_mapping_to_classes_of_its_protocols(kind: str) -> None:
    signature = inspect.signature(HOOKS[KINDS[kind].hook])
    assert not signature.parameters
    protocols = " | ".join(each.__name__ for each in (KINDS[kind].protocol, *KINDS[kind].others))
    assert signature.return_annotation == f"Mapping[str, type[{protocols}]]"


def test_a_plugin_may_take_fewer_arguments_but_no_others() -> None:
    manager = pluggy.PluginManager("evoframe")
    manager.add_hookspecs(hookspecs)

    class Some:
        @hookspecs.hookimpl
        def evoframe_run_finished(self, completed: bool) -> None: ...

    class Other:
        @hookspecs.hookimpl
        def evoframe_run_finished(self, complete: bool) -> None: ...

    manager.register(Some())
    with pytest.raises(pluggy.PluginValidationError, match="complete"):
        manager.register(Other())
