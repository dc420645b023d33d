"""Values that travel: nobody changes them on the way."""

from __future__ import annotations

import numpy as np
import pytest

from evoframe import Design


def test_a_design_cannot_be_changed_behind_the_cache() -> None:
    array = np.array([1.0])
    given_design = Design({"a": array})
    array[0] = 2.0
    assert given_design.roles["a"][0] == 1.0
    with pytest.raises(ValueError, match="read-only"):
        given_design.roles["a"][0] = 3.0
