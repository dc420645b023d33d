import math

import numpy as np
import pytest
from crediting import ANY, scores_of
from hypothesis import given

from evoframe import ConfigurationError
from evoframe_aggregators.scores import ascending, between, counted, require_one


@given(scores_of(ANY))
def test_scores_are_sorted(scores: list[float]) -> None:
    assert ascending(np.array(scores)) == sorted(scores)


@pytest.mark.parametrize("scores", [[], [math.nan], [1.0, math.inf], [1.0, -math.inf]], ids=str)
def test_invalid_scores_are_refused(scores: list[float]) -> None:
    with pytest.raises(ValueError, match="expected"):
        ascending(np.array(scores))


def test_one_collaborator_is_required() -> None:
    require_one("am", 1)
    with pytest.raises(ConfigurationError, match="am requires at least 1 collaborator, found 0"):
        require_one("am", 0)


@pytest.mark.parametrize(("mean", "clamped"), [(0.5, 1.0), (1.5, 1.5), (2.5, 2.0)])
def test_a_mean_is_clamped_to_its_range(mean: float, clamped: float) -> None:
    assert between(1.0, mean, 2.0) == clamped


def test_nouns_agree_with_their_number() -> None:
    assert [counted(n, "weight") for n in (0, 1, 2)] == ["0 weights", "1 weight", "2 weights"]
