"""The laws of simulators."""

from __future__ import annotations

import re
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor

import attrs
import numpy as np
import pytest

from evoframe.contract import (
    Design,
    Export,
    Geometry,
    Outcome,
    Record,
    Simulator,
    SupportsExport,
    SupportsGeometry,
    SupportsPublished,
    SupportsRandomControllers,
    SupportsVariants,
    Variant,
)
from evoframe.errors import ConfigurationError
from evoframe.record import UNCHANGED
from evoframe.testing.components import ComponentContract
from evoframe.testing.laws import assert_is_mesh, same_arrays, same_outcome

__all__ = ["SimulatorContract"]


class SimulatorContract(ComponentContract[Simulator]):
    """The laws of a :class:`~evoframe.Simulator`.

    A subclass overrides :meth:`designs`, and :meth:`diverging` if a simulation can diverge. What diverges at
    step 0 has never begun, and may have no samples. What a simulator may offer or not (variants, formats,
    random controllers, published bodies) is tested where it is offered.
    """

    protocol = Simulator

    def designs(self) -> Sequence[Design]:
        """Return at least three designs, best with some whose keys are equal though they differ."""
        pytest.fail("override designs() with at least three examples")

    def diverging(self) -> Sequence[Design]:
        """Return designs whose simulation diverges."""
        return []

    def record(self) -> Record:
        """Return what is recorded; every track after every step, unless overridden."""
        return Record(tuple(self.component.tracks))

    def test_there_are_three_examples_with_the_required_roles(self) -> None:
        """Otherwise the other tests say little."""
        assert len(self.designs()) >= 3
        for design in [*self.designs(), *self.diverging()]:
            assert set(self.component.requires) <= set(design.roles)

    def test_a_record_of_its_tracks_is_accepted(self) -> None:
        """There is at least one."""
        assert self.component.tracks
        self.component.check(self.record())

    def test_an_unknown_track_is_refused(self) -> None:
        """Before anything runs."""
        with pytest.raises(ConfigurationError, match="no-such-track"):
            self.component.check(Record(("no-such-track",)))

    def test_a_sample_after_the_end_is_refused(self) -> None:
        """Before anything runs."""
        with pytest.raises(ConfigurationError):
            self.component.check(attrs.evolve(self.record(), samples=(10**9,)))

    def test_an_end_before_the_time_to_be_reached_is_refused(self) -> None:
        """Before anything runs; a time that is reached is no reason."""
        self.component.check(attrs.evolve(self.record(), until=0.0))
        with pytest.raises(ConfigurationError):
            self.component.check(attrs.evolve(self.record(), until=1e9))

    def test_the_time_to_be_reached_changes_nothing(self) -> None:
        """It only says what is too short."""
        reached = min(float(o.times[-1]) for o in self._simulate(self.designs()) if len(o.times))
        until = attrs.evolve(self.record(), until=reached / 2)
        self.component.check(until)
        _assert_same(self._simulate(self._all(), until), self._simulate(self._all()))

    def test_each_design_has_an_outcome(self) -> None:
        """No design, no outcome."""
        assert len(self._simulate(self.designs())) == len(self.designs())
        assert len(self._simulate([])) == 0

    def test_outcomes_have_the_promised_arrays(self) -> None:
        """One row a sample in each of them."""
        record = self.record()
        for outcome in self._simulate(self._all()):
            samples = len(outcome.steps)
            if record.samples is not None and _has_begun(outcome):
                assert samples == len(record.samples) + record.initial
            assert outcome.steps.dtype == np.int64
            assert outcome.times.dtype == np.float64
            assert outcome.times.shape == (samples,)
            assert set(outcome.tracks) == set(record.tracks)
            for name, track in outcome.tracks.items():
                assert track.dtype == np.float64
                assert track.shape[:1] == (samples,)
                if name in self.component.tracks:
                    assert track.shape == (samples, 3), f"the track '{name}' is no point"

    def test_time_goes_on(self) -> None:
        """From sample to sample, in steps and in seconds."""
        for outcome in self._simulate(self._all()):
            assert (np.diff(outcome.steps) > 0).all()
            assert (np.diff(outcome.times) > 0).all()

    def test_positions_are_finite_unless_the_simulation_diverged(self) -> None:
        """Nothing is hidden: who has a NaN says at which step it came."""
        for outcome in self._simulate(self._all()):
            sound = outcome.steps < (np.inf if outcome.diverged_at is None else outcome.diverged_at)
            for track in outcome.tracks.values():
                assert np.isfinite(track[sound]).all()

    def test_divergence_is_said(self) -> None:
        """The step is named, and from there on positions are NaN."""
        for outcome in self._simulate(self.diverging()):
            assert outcome.diverged_at is not None
            lost = outcome.steps >= outcome.diverged_at
            for track in outcome.tracks.values():
                assert np.isnan(track[lost]).all()

    def test_a_simulation_can_be_repeated(self) -> None:
        """To the last bit."""
        _assert_same(self._simulate(self._all()), self._simulate(self._all()))

    def test_a_batch_equals_its_members_one_by_one(self) -> None:
        """To the last bit, in any order, and beside a design that diverges."""
        together = self._simulate(self._all())
        _assert_same(together, [self._simulate([design])[0] for design in self._all()])
        _assert_same(together, self._simulate(self._all()[::-1])[::-1])

    def test_any_number_of_threads_may_call_at_once(self) -> None:
        """To the last bit."""
        designs = self._all() * 4
        with ThreadPoolExecutor(4) as pool:
            outcomes = list(pool.map(lambda design: self._simulate([design])[0], designs))
        _assert_same(outcomes, list(self._simulate(self._all())) * 4)

    def test_recording_more_tracks_changes_nothing(self) -> None:
        """Each track alone is the same as among the others."""
        whole = self._simulate(self._all())
        for track in self.record().tracks:
            alone = self._simulate(self._all(), attrs.evolve(self.record(), tracks=(track,)))
            for one, all_ in zip(alone, whole, strict=True):
                assert same_outcome(one, attrs.evolve(all_, tracks={track: all_.tracks[track]}))

    def test_recording_more_samples_changes_nothing(self) -> None:
        """One sample alone is the same as among the others."""
        every_sample = attrs.evolve(self.record(), samples=None, initial=False)
        whole = self._simulate(self._all(), every_sample)
        last = min(len(outcome.steps) for outcome in whole if _has_begun(outcome)) - 1
        for sample in sorted({0, last // 2, last}):
            record = attrs.evolve(every_sample, samples=(sample,))
            for one, all_ in zip(self._simulate(self._all(), record), whole, strict=True):
                if _has_begun(all_):
                    assert same_outcome(one, _rows(all_, slice(sample, sample + 1)))

    def test_the_initial_state_is_one_more_row(self) -> None:
        """In front of the others, before the first step."""
        whole = self._simulate(self._all(), attrs.evolve(self.record(), initial=False))
        more = self._simulate(self._all(), attrs.evolve(self.record(), initial=True))
        for one, all_ in zip(more, whole, strict=True):
            if _has_begun(all_):
                assert one.steps[0] == 0
                assert one.times[0] == 0
                assert same_outcome(_rows(one, slice(1, None)), all_)

    def test_sampling_more_often_changes_nothing(self) -> None:
        """Where two records have a step in common, they agree."""
        often = self._simulate(self._all(), Record(self.record().tracks))
        every = float(often[0].times[-1]) / 3
        seldom = self._simulate(self._all(), Record(self.record().tracks, every=every))
        for one, all_ in zip(seldom, often, strict=True):
            assert set(one.steps) <= set(all_.steps)
            assert same_outcome(one, _rows(all_, np.isin(all_.steps, one.steps)))

    def test_keys_are_bytes_and_equal_for_equal_designs(self) -> None:
        """A copy of a design has its key."""
        for design in self._all():
            copy = Design({role: array.copy() for role, array in design.roles.items()})
            key = self.component.key(design, self.record())
            assert isinstance(key, bytes)
            assert key == self.component.key(copy, self.record())

    def test_equal_keys_mean_equal_outcomes(self) -> None:
        """Whatever a key leaves out cannot matter; what is recorded is part of it."""
        known: dict[bytes, Outcome] = {}
        shorter = attrs.evolve(self.record(), samples=(0,))
        for record in (self.record(), shorter):
            for design, outcome in zip(self._all(), self._simulate(self._all(), record), strict=True):
                first = known.setdefault(self.component.key(design, record), outcome)
                assert same_outcome(first, outcome)

    def test_variants_are_scored_by_the_same_objective(self) -> None:
        """Each has a name, and an outcome with the tracks and as many samples as the unchanged simulation."""
        record = self.record()
        for design in self.designs():
            [unchanged] = self._simulate([design])
            for variant in self._variants(design):
                assert isinstance(variant, Variant)
                assert variant.name.strip(), "a variant needs a name"
                assert variant.name != UNCHANGED, f"evoframe itself simulates what is {UNCHANGED}"
                variant.simulator.check(variant.record)
                [outcome] = variant.simulator.simulate([variant.design], variant.record)
                assert variant.record.tracks == record.tracks
                assert variant.record.initial == record.initial
                assert (variant.record.samples is None) == (record.samples is None)
                if record.samples is not None and _has_begun(outcome) and _has_begun(unchanged):
                    assert len(outcome.steps) == len(unchanged.steps)

    def test_the_same_design_has_the_same_variants(self) -> None:
        """To the last bit, whatever chance has drawn."""
        for design in self.designs():
            first, second = self._variants(design), self._variants(design)
            for one, other in zip(first, second, strict=True):
                assert (one.name, one.simulator, one.record) == (other.name, other.simulator, other.record)
                assert same_arrays(one.design.roles, other.design.roles)

    def test_each_format_gives_the_same_bytes_twice(self) -> None:
        """With what it cannot say in words."""
        component = self.component
        assert hasattr(component, "formats") == hasattr(component, "export"), "one of both is missing"
        if not isinstance(component, SupportsExport):
            return
        for format_ in component.formats:
            assert re.fullmatch("[a-z0-9]+", format_), f"'{format_}' cannot be the ending of a file"
            assert format_ != "json", "a run's champion.json is evoframe's own"
            for design in self.designs():
                first, second = (component.export(design, format_) for _ in range(2))
                assert isinstance(first, Export)
                assert isinstance(first.data, bytes)
                assert first.data, "an export without any bytes"
                assert all(isinstance(entry, str) and entry.strip() for entry in first.left_out)
                assert first == second

    def test_a_geometry_has_frames_of_meshes(self) -> None:
        """As many as asked for at most, from rest on; every face has corners, every part is to be seen."""
        asked = [(frames, geometry) for frames in (1, 2, 7) for geometry in self._geometries(frames)]
        for frames, geometry in asked:
            assert 1 <= len(geometry.times) <= frames
            assert geometry.times[0] == 0.0
            assert (np.diff(geometry.times) > 0).all()
            assert geometry.parts
            for part in geometry.parts:
                assert_is_mesh(part, len(geometry.times))
            for name, track in geometry.tracks.items():
                assert name in self.component.tracks
                assert track.shape == (len(geometry.times), 3)
                assert np.isfinite(track).all()

    def test_one_frame_is_the_first_of_many(self) -> None:
        """To the last bit: what moves starts from what stands still."""
        for one, many in zip(self._geometries(1), self._geometries(5), strict=True):
            for part, moving in zip(one.parts, many.parts, strict=True):
                assert np.array_equal(part.vertices[0], moving.vertices[0])
                assert np.array_equal(part.faces, moving.faces)

    def _geometries(self, frames: int) -> list[Geometry]:
        if not isinstance(self.component, SupportsGeometry):
            return []
        return [self.component.geometry(design, frames) for design in self.designs()]

    def test_a_random_controller_is_that_of_the_generators_state(self) -> None:
        """The same again from the same state, another from another."""
        for design in self.designs() if isinstance(self.component, SupportsRandomControllers) else []:
            one, again, other = (self._drawn(design, seed).roles for seed in (1, 1, 2))
            assert same_arrays(one, again)
            assert not same_arrays(one, other), "chance changes nothing"

    def test_a_random_controller_leaves_the_body(self) -> None:
        """The roles stay, at least one of them as it was, and there is something to simulate."""
        for design in self.designs() if isinstance(self.component, SupportsRandomControllers) else []:
            drawn = self._drawn(design, 1)
            assert isinstance(drawn, Design)
            assert set(drawn.roles) == set(design.roles)
            assert self._kept(design), "nothing is left of the body"
            assert len(self._simulate([drawn])) == 1

    def test_bodies_of_the_same_shape_are_given_the_same_random_controller(self) -> None:
        """Whatever they are made of."""
        known: dict[str, np.ndarray] = {}
        for design in self.designs() if isinstance(self.component, SupportsRandomControllers) else []:
            drawn = self._drawn(design, 1)
            shapes = repr(sorted((role, array.shape) for role, array in design.roles.items()))
            for role in sorted(set(drawn.roles) - self._kept(design)):
                first = known.setdefault(f"{role} of {shapes}", drawn.roles[role])
                assert same_arrays({role: first}, {role: drawn.roles[role]})

    def test_published_bodies_can_be_simulated(self) -> None:
        """Each has a name of its own; they are the same every time."""
        first, second = (
            [*self.component.published()] if isinstance(self.component, SupportsPublished) else []
            for _ in "12"
        )
        labels = [label for label, _ in first]
        assert all(isinstance(label, str) and label.strip() for label in labels)
        assert len(set(labels)) == len(labels), "two bodies have one name"
        for (label, design), (same_label, same) in zip(first, second, strict=True):
            assert set(self.component.requires) <= set(design.roles)
            assert label == same_label
            assert same_arrays(design.roles, same.roles)
            assert len(self._simulate([design])) == 1

    def _drawn(self, design: Design, seed: int) -> Design:
        assert isinstance(self.component, SupportsRandomControllers)
        return self.component.random_controller(design, np.random.default_rng(seed))

    def _kept(self, design: Design) -> set[str]:
        """Return the roles that no random controller changes."""
        drawn = [self._drawn(design, seed).roles for seed in (1, 2)]
        return {
            role
            for role, array in design.roles.items()
            if all(same_arrays({role: array}, {role: roles[role]}) for roles in drawn)
        }

    def _variants(self, design: Design) -> Sequence[Variant]:
        return (
            self.component.variants(design, self.record())
            if isinstance(self.component, SupportsVariants)
            else []
        )

    def _all(self) -> list[Design]:
        return [*self.designs(), *self.diverging()]

    def _simulate(self, designs: Sequence[Design], record: Record | None = None) -> Sequence[Outcome]:
        return self.component.simulate(designs, record or self.record())


def _assert_same(outcomes: Sequence[Outcome], others: Sequence[Outcome]) -> None:
    for one, other in zip(outcomes, others, strict=True):
        assert same_outcome(one, other)


def _has_begun(outcome: Outcome) -> bool:
    return outcome.diverged_at != 0


def _rows(outcome: Outcome, rows: slice | np.ndarray) -> Outcome:
    """Return *outcome* with some of its samples."""
    return attrs.evolve(
        outcome,
        steps=outcome.steps[rows],
        times=outcome.times[rows],
        tracks={name: track[rows] for name, track in outcome.tracks.items()},
    )
