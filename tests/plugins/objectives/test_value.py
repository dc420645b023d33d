"""The objective ``value``."""

from __future__ import annotations

from typing import Any

import numpy as np
from hypothesis import given, strategies as st

from evoframe import Outcome
from evoframe.testing import ObjectiveContract
from evoframe_objectives import Value


def outcome(value: float) -> Outcome:
    return Outcome(np.ones(1, np.int64), np.ones(1), {"value": np.full((1, 1), value)})


class TestContract(ObjectiveContract):
    component = Value()

    def outcomes(self) -> Any:
        return st.builds(outcome, st.floats(-1e9, 1e9))


@given(value=st.floats(-1e9, 1e9))
def test_the_score_is_the_value(value: float) -> None:
    assert Value().score(outcome(value)).hex() == value.hex()
