"""Verdicts on verifications."""

from __future__ import annotations

import attrs
import numpy as np
import pytest
from attrs import evolve

from evoframe import Design, RunConfig, Score, Verification
from evoframe.designs import verdict
from evoframe.record import WITHIN_REACH, Finding


@pytest.fixture
def config(toy_config: object) -> RunConfig:
    assert callable(toy_config)
    config: RunConfig = toy_config("simulator=toy-varied")
    return config


DESIGN = Design({"a": np.array([1.0]), "b": np.array([1.0])})


def verification(**shares: float | None) -> Verification:
    """Return a verification of a score of 2 with the given shares of it."""
    findings = [
        Finding(name.replace("_", " "), (Score(None, 1) if share is None else Score(2.0 * share, None),))
        for name, share in shares.items()
    ]
    return Verification(Score(2.0, None), tuple(findings))


@pytest.mark.parametrize(
    ("share", "text"),
    [
        (1.0, "The score ignores gain (100% of unchanged)."),
        (0.9, "The score ignores gain (90% of unchanged)."),
        (1.1, "The score ignores gain (110% of unchanged)."),
        (2.4, "The score becomes 240% with gain off."),
        (0.7, "The score becomes 70% with gain off."),
        (0.5, "The score comes from gain (50% of unchanged)."),
        (-0.2, "The score comes from gain (-20% of unchanged)."),
        (None, "The score diverges with gain off."),
    ],
)
def test_a_clause_follows_from_the_share(config: RunConfig, share: float | None, text: str) -> None:
    assert verdict(verification(gain_off=share), config, DESIGN) == text


def test_clauses_stand_in_the_order_of_the_findings(config: RunConfig) -> None:
    text = verdict(verification(no_room=1.0, gain_off=0.0), config, DESIGN)
    assert text.index("fits anywhere") < text.index("comes from gain")


def test_a_variant_without_clauses_is_named(config: RunConfig) -> None:
    name = "one number jittered by 10 %"
    found = evolve(verification(), findings=(Finding(name, (Score(2.0, None),)),))
    assert name in verdict(found, config, DESIGN)


def test_a_divergence_that_the_score_does_not_show_is_stated(config: RunConfig) -> None:
    found = evolve(
        verification(gain_off=None),
        unchanged=Score(None, 7),
        findings=(Finding(WITHIN_REACH, (Score(0.0125),)), Finding("gain off", (Score(None, 7),))),
        unit="m",
    )
    assert verdict(found, config, DESIGN) == (
        "The design diverges at step 7, out of reach of the samples; its score of 12.5 mm does not show it."
    )


def test_without_a_score_there_is_no_verdict(config: RunConfig) -> None:
    assert verdict(attrs.evolve(verification(gain_off=1.0), unchanged=Score(None, 1)), config, DESIGN) == ""


def test_without_variants_there_is_no_verdict(config: RunConfig, toy_config: object) -> None:
    assert callable(toy_config)
    assert verdict(verification(gain_off=1.0), toy_config("simulator=toy-product"), DESIGN) == ""
