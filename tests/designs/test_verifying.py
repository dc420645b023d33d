"""Verification of designs: the simulations and their findings."""

from __future__ import annotations

from typing import Any

import attrs
import numpy as np
import pytest
import toys

from evoframe import Design, Outcome, Record, Score, Variant
from evoframe.contract.optional import SupportsVariants
from evoframe.designs.verifying import verify_design
from evoframe.record import WITHIN_REACH
from evoframe_executors import Threads

PAIR = Design({"a": np.array([3.0]), "b": np.array([-2.0])})


def test_a_design_is_simulated_unchanged_and_in_every_variant() -> None:
    verification = verify_design(toys.Varied(gain=2.0), toys.Value(), PAIR, toys.Here(), -12.0)
    assert verification.unchanged == Score(-12.0)
    assert verification.score == -12.0
    gain, room, jittered = verification.findings
    assert (gain.name, gain.scores) == ("gain off", (Score(0.0),))
    assert (room.name, room.scores) == ("no room", (Score(None, 1),))
    assert jittered.name == "one number jittered by 10 %"
    assert jittered.values == pytest.approx([-13.2, -13.2, -10.8, -10.8])


@pytest.mark.parametrize("workers", [1, 2, 5])
def test_workers_do_not_change_the_result(workers: int) -> None:
    pool = Threads(workers=workers).start()
    alone = verify_design(toys.Varied(), toys.Value(), PAIR, toys.Here())
    assert verify_design(toys.Varied(), toys.Value(), PAIR, pool) == alone
    pool.close()


def test_the_unit_is_that_of_the_objective() -> None:
    assert verify_design(toys.Varied(), toys.Value(), PAIR, toys.Here()).unit == ""
    assert verify_design(toys.Varied(), toys.Late(), PAIR, toys.Here()).unit == "m"


def test_a_variant_has_its_own_simulator_and_record() -> None:
    class Watched(toys.Varied):
        def variants(self, design: Design, record: Any) -> Any:
            return [Variant("later", Later(), design, Record(("value",), until=0.5))]

    class Later(toys.Varied):
        def simulate(self, designs: Any, record: Any) -> list[Outcome]:
            return [
                Outcome(np.array([1]), np.array([1.0]), {"value": np.full((1, 3), record.until)})
                for _ in designs
            ]

    [later] = verify_design(Watched(), toys.Value(), PAIR, toys.Here()).findings
    assert later.scores == (Score(0.5),)


class TestWholeDesigns:
    """What a run overlooks is seen."""

    torn = toys.Shortsighted(gain=2.0, torn_at=7)

    def test_that_diverge_have_no_score_but_one_within_reach_of_the_samples(self) -> None:
        verification = verify_design(self.torn, toys.Late(), PAIR, toys.Here(), -12.0)
        assert verification.unchanged == Score(None, 7)
        seen, *others = verification.findings
        assert (seen.name, seen.scores) == (WITHIN_REACH, (Score(-12.0),))
        assert verification.within_reach == verification.score == -12.0
        diverged_at = {step for finding in others for step in finding.diverged_at}
        assert diverged_at == {7}  # variants are whole designs, too

    def test_that_do_not_diverge_are_verified_like_any_other(self) -> None:
        whole = verify_design(toys.Shortsighted(gain=2.0), toys.Value(), PAIR, toys.Here())
        assert whole == verify_design(toys.Varied(gain=2.0), toys.Value(), PAIR, toys.Here())
        assert whole.within_reach is None

    def test_that_diverge_within_reach_have_no_score(self) -> None:
        verification = verify_design(attrs.evolve(self.torn, limit=1.0), toys.Value(), PAIR, toys.Here())
        assert verification.unchanged.value is None
        assert WITHIN_REACH not in [finding.name for finding in verification.findings]
        assert verification.within_reach is None


def test_only_simulators_with_variants_can_verify() -> None:
    assert isinstance(toys.Varied(), SupportsVariants)
    assert not isinstance(toys.Product(), SupportsVariants)
