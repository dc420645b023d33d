"""The figures of a verification and its JSON."""

from __future__ import annotations

import json
import math
import statistics
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import toys
from hypothesis import given, strategies as st

from evoframe import Design, Finding, InputError, Score, Verification
from evoframe.designs.verifying import verify_design
from evoframe.record.verification import verification_from_json

PAIR = Design({"a": np.array([3.0]), "b": np.array([-2.0])})


values = st.floats(-1e100, 1e100)


scores = st.one_of(values.map(Score), st.integers(0, 10**9).map(lambda step: Score(None, step)))


findings = st.builds(Finding, st.text(min_size=1), st.lists(scores, min_size=1, max_size=5).map(tuple))


verifications = st.builds(
    Verification,
    scores,
    st.lists(findings, max_size=4).map(tuple),
    st.sampled_from(["", "m", "m/s"]),
    st.one_of(st.none(), values),
)


class TestFigures:
    @given(findings)
    def test_the_median_lies_within_the_range_of_the_clean_draws(self, finding: Finding) -> None:
        clean = [score.value for score in finding.scores if score.value is not None]
        assert len(clean) + len(finding.diverged_at) == len(finding.scores)
        if not clean:
            assert finding.median is None
        else:
            assert finding.median == statistics.median(clean)
            assert finding.values[0] <= finding.median <= finding.values[-1]

    @given(verifications)
    def test_the_share_of_the_unchanged_design_is_one(self, verification: Verification) -> None:
        share = verification.share(verification.rows[0])
        assert share == (1.0 if verification.unchanged.value else None)

    @given(verifications)
    def test_a_share_is_a_finite_fraction_of_the_unchanged_score(self, verification: Verification) -> None:
        for finding in verification.findings:
            share = verification.share(finding)
            if share is not None:
                assert math.isfinite(share)
                assert verification.unchanged.value is not None
                expected = finding.median
                assert expected is not None
                assert math.isclose(share * verification.unchanged.value, expected, abs_tol=1e-200)

    @pytest.mark.parametrize("unchanged", [Score(0.0), Score(None, 3), Score(5e-324)])
    def test_there_is_no_share_of_a_missing_or_zero_score(self, unchanged: Score) -> None:
        verification = Verification(unchanged, (Finding("changed", (Score(1.0),)),))
        assert verification.share(verification.findings[0]) is None


class TestJson:
    @given(verifications)
    def test_is_read_back_exactly(self, verification: Verification) -> None:
        text = json.dumps(verification.to_json(), allow_nan=False)
        assert verification_from_json(json.loads(text)) == verification

    def test_names_all_figures(self) -> None:
        document = verify_design(toys.Varied(), toys.Late(), PAIR, toys.Here(), -6.0).to_json()
        assert (document["format"], document["score"], document["unit"]) == (1, -6.0, "m")
        assert [row["name"] for row in document["variants"]] == [
            "unchanged", "gain off", "no room", "one number jittered by 10 %",
        ]  # fmt: skip
        unchanged, gain, room, jittered = document["variants"]
        assert unchanged["draws"] == [{"score": -6.0, "diverged_at": None}]
        assert (gain["median"], gain["share"]) == (0.0, 0.0)
        assert room == {
            "name": "no room", "median": None, "least": None, "greatest": None, "share": None,
            "draws": [{"score": None, "diverged_at": 1}],
        }  # fmt: skip
        assert [jittered[key] for key in ("least", "median", "greatest", "share")] == pytest.approx(
            [-6.6, -6.0, -5.4, 1.0]
        )

    @pytest.mark.parametrize(
        ("damage", "key", "data"),
        [
            (lambda d: [d], "", ""),
            (lambda d: {"format": 1}, "", ""),
            (lambda d: {**d, "format": 2}, "format", "2"),
            (lambda d: {**d, "format": True}, "format", "True"),
            (lambda d: {**d, "variants": []}, "variants", "one score"),
            (lambda d: {**d, "variants": 7}, "variants", "rows"),
            (lambda d: {**d, "variants": [None]}, "variants", "rows"),
            (lambda d: {key: d[key] for key in d if key != "unit"}, "variants", "rows"),
            (lambda d: with_draw(d, score="high"), "variants", "'high'"),
            (lambda d: with_draw(d, score=math.nan), "variants", "nan"),
            (lambda d: with_draw(d, diverged_at=4), "variants", "-6.0 and 4"),
            (lambda d: with_draw(d, score=None), "variants", "None and None"),
            (lambda d: with_draw(d, score=-7.0), "", "figures"),
            (lambda d: {**d, "more": 1}, "", "figures"),
        ],
    )
    def test_that_was_changed_is_refused(self, damage: Callable[[Any], Any], key: str, data: str) -> None:
        document = verify_design(toys.Varied(), toys.Value(), PAIR, toys.Here()).to_json()
        with pytest.raises(InputError) as caught:
            verification_from_json(damage(document))
        assert caught.value.key == key
        assert data in caught.value.problem


def with_draw(document: Any, **changed: Any) -> Any:
    """Return a document with a changed draw of the unchanged design."""
    first, *others = document["variants"]
    [draw] = first["draws"]
    return {**document, "variants": [{**first, "draws": [{**draw, **changed}]}, *others]}
