"""Tests of the subpackages of the analysis: their exported names, and lazy loading."""

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
def test_a_subpackage_has_a_docstring_and_its_exported_names(name: str) -> None:
    room = getattr(analysis, name)
    assert isinstance(room, ModuleType)
    assert room.__doc__
    assert room.__all__ == [*dict.fromkeys(room.__all__)]
    for offered in room.__all__:
        assert not inspect.ismodule(getattr(room, offered)), offered


@pytest.mark.parametrize("name", ROOMS)
def test_no_module_has_the_name_of_an_exported_object(name: str) -> None:
    room = importlib.import_module(f"evoframe.analysis.{name}")
    modules = {module.name for module in pkgutil.iter_modules(room.__path__)}
    assert not modules & {*room.__all__}


@pytest.mark.parametrize("module", ["evoframe.analysis", "evoframe.analysis.statistics"])
def test_a_missing_attribute_is_an_error(module: str) -> None:
    with pytest.raises(AttributeError, match="nothing"):
        importlib.import_module(module).nothing  # noqa: B018 - the access must fail


def test_the_first_use_of_a_subpackage_loads_its_libraries() -> None:
    program = (
        "import sys, evoframe.analysis; print('matplotlib' in sys.modules or 'pandas' in sys.modules);"
        "evoframe.analysis.networks.network; print('matplotlib' in sys.modules)"
    )
    assert python("-c", program).stdout.split() == ["False", "True"]
