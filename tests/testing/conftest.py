from collections.abc import Callable, Iterator
from typing import Any

import pytest
from hypothesis import Phase, settings

Law = str


@pytest.fixture
def laws() -> Callable[..., list[Law]]:
    """Return a function that lists the names of the laws of a contract."""

    def listed(contract: type[Any]) -> list[Law]:
        return [name for name in dir(contract) if name.startswith("test_")]

    return listed


@pytest.fixture
def keeps() -> Callable[..., None]:
    """Return a function that tests one law of a contract with a component."""

    def run(contract: type[Any], component: Any, law: Law, **attributes: Any) -> None:
        subclass = type("TestComponent", (contract,), {"component": component, **attributes})
        getattr(subclass(), law)()

    return run


@pytest.fixture
def first_failure_only() -> Iterator[None]:
    """Make hypothesis stop at the first failure, instead of searching for the simplest one."""
    profile = settings.get_current_profile_name()
    settings.register_profile("first-failure-only", phases=[Phase.generate], database=None)
    settings.load_profile("first-failure-only")
    yield
    settings.load_profile(profile)


@pytest.fixture
def breaks(keeps: Callable[..., None], first_failure_only: None) -> Callable[..., None]:
    """Return a function that asserts that a law catches a component, by default with a failed assertion."""

    def run(
        contract: type[Any],
        component: Any,
        law: Law,
        error: Any = (AssertionError, pytest.fail.Exception),
        **attributes: Any,
    ) -> None:
        try:
            keeps(contract, component, law, **attributes)
        except error:
            return
        except ExceptionGroup as group:  # several assertions of one law
            others = group.split(error)[1]
            if others:
                raise others from group
            return
        pytest.fail(f"{law} did not catch {component!r}")

    return run
