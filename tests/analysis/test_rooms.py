"""The rooms of the analysis offer what they name, and cost nothing before they are used."""

from __future__ import annotations

import importlib
import inspect
import pkgutil
from types import ModuleType

import pytest
from processes import python

from evoframe import analysis

ROOMS = [module.name for module in pkgutil.iter_modules(analysis.__path__) if module.ispkg]


@pytest.mark.parametrize("name", ROOMS)
def test_a_room_says_what_it_is_for_and_has_what_it_names(name: str) -> None:
    room = getattr(analysis, name)
    assert isinstance(room, ModuleType)
    assert room.__doc__
    assert room.__all__ == [*dict.fromkeys(room.__all__)]
    for offered in room.__all__:
        assert not inspect.ismodule(getattr(room, offered)), offered


@pytest.mark.parametrize("name", ROOMS)
def test_no_module_has_the_name_of_what_its_room_offers(name: str) -> None:
    room = importlib.import_module(f"evoframe.analysis.{name}")
    modules = {module.name for module in pkgutil.iter_modules(room.__path__)}
    assert not modules & {*room.__all__}


@pytest.mark.parametrize("module", ["evoframe.analysis", "evoframe.analysis.statistics"])
def test_what_is_not_there_is_no_attribute(module: str) -> None:
    with pytest.raises(AttributeError, match="nothing"):
        importlib.import_module(module).nothing  # noqa: B018 - it is asked for


def test_the_first_use_of_a_room_loads_its_libraries() -> None:
    program = (
        "import sys, evoframe.analysis; print('matplotlib' in sys.modules or 'pandas' in sys.modules);"
        "evoframe.analysis.networks.network; print('matplotlib' in sys.modules)"
    )
    assert python("-c", program).stdout.split() == ["False", "True"]
