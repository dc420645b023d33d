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
    SupportsDuration,
    SupportsExport,
    SupportsGeometry,
    SupportsObjective,
    SupportsPublished,
    SupportsRandomControllers,
    SupportsVariants,
    SupportsWholeDesigns,
    Variant,
)
from evoframe.errors import ConfigurationError
from evoframe.record import UNCHANGED
from evoframe.testing.components import ComponentContract
from evoframe.testing.laws import assert_is_mesh, same_arrays, same_outcome

__all__ = ["SimulatorContract"]


class SimulatorContract(ComponentContract[Simulator]):
    """The laws of a :class:`~evoframe.Simulator`.

    Override :meth:`designs`, and :meth:`diverging` if a simulation can diverge. A simulation that diverges at
    step 0 has not started, and may have no samples. Optional capabilities (duration, suggested objective,
    variants, formats, geometries, random controllers, published bodies) are tested if the simulator has them.

    Recording more must change nothing. Only in a simulator that offers ``for_whole_designs`` may a divergence
    depend on what is recorded: the outcome of a smaller record may diverge later or not at all.
    """

    protocol = Simulator

    def designs(self) -> Sequence[Design]:
        """Return at least three designs, preferably with some that differ but have equal keys."""
        pytest.fail("override designs() to return at least three examples")

    def diverging(self) -> Sequence[Design]:
        """Return designs whose simulation diverges."""
        return []

    def record(self) -> Record:
        """Return the record of the tests; by default, all points after every step.

        Override it for a simulator without points, whose other tracks the tests then record.
        """
        return Record(tuple(self.component.tracks))

    def test_there_are_three_examples_with_the_required_roles(self) -> None:
        """``designs`` returns at least three designs with all required roles; the other tests use them."""
        n_designs = len(self.designs())
        assert n_designs >= 3, f"override designs() to return at least three examples, found {n_designs}"
        for design in [*self.designs(), *self.diverging()]:
            missing = sorted(set(self.component.requires) - set(design.roles))
            assert not missing, f"designs() and diverging() must have the required roles, missing: {missing}"

    def test_a_record_of_its_tracks_is_accepted(self) -> None:
        """There is at least one track, and ``check`` accepts all of them."""
        assert self.record().tracks, (
            "expected at least one track, found none; override record() for a simulator without points"
        )
        self.component.check(self.record())

    def test_an_unknown_track_is_refused(self) -> None:
        """``check`` refuses an unknown track by a ``ConfigurationError`` that names it."""
        with pytest.raises(ConfigurationError, match="no-such-track"):
            self.component.check(Record(("no-such-track",)))

    def test_a_sample_after_the_end_is_refused(self) -> None:
        """``check`` refuses a sample after the end of the simulation."""
        with pytest.raises(ConfigurationError):
            self.component.check(attrs.evolve(self.record(), samples=(10**9,)))

    def test_a_simulation_that_ends_before_record_until_is_refused(self) -> None:
        """``check`` refuses a record whose ``until`` is after the end, and accepts one that is reached."""
        self.component.check(attrs.evolve(self.record(), until=0.0))
        with pytest.raises(ConfigurationError):
            self.component.check(attrs.evolve(self.record(), until=1e9))

    def test_record_until_does_not_change_outcomes(self) -> None:
        """``Record.until`` is a requirement only, and does not change outcomes."""
        reached = min(float(o.times[-1]) for o in self._simulate(self.designs()) if len(o.times))
        until = attrs.evolve(self.record(), until=reached / 2)
        self.component.check(until)
        _assert_same(
            self._simulate(self._all(), until), self._simulate(self._all()), "Record.until changes outcomes"
        )

    def test_each_design_has_an_outcome(self) -> None:
        """``simulate`` returns one outcome per design, none for an empty batch."""
        outcomes, designs = len(self._simulate(self.designs())), len(self.designs())
        assert outcomes == designs, f"expected {designs} outcomes for {designs} designs, found {outcomes}"
        outcomes = len(self._simulate([]))
        assert outcomes == 0, f"expected no outcomes for an empty batch, found {outcomes}"

    def test_outcomes_have_the_promised_arrays(self) -> None:
        """All arrays of an outcome have the declared types, and one row per sample."""
        record = self.record()
        for outcome in self._simulate(self._all()):
            samples = len(outcome.steps)
            if record.samples is not None and _has_started(outcome):
                expected = len(record.samples) + record.initial
                assert samples == expected, f"the record requires {expected} samples, found {samples}"
            assert outcome.steps.dtype == np.int64, f"steps must be int64, found {outcome.steps.dtype}"
            assert outcome.times.dtype == np.float64, f"times must be float64, found {outcome.times.dtype}"
            assert outcome.times.shape == (samples,), (
                f"times must have shape ({samples},) like steps, found {outcome.times.shape}"
            )
            assert set(outcome.tracks) == set(record.tracks), (
                f"an outcome must have the recorded tracks {record.tracks}, found {tuple(outcome.tracks)}"
            )
            for name, track in outcome.tracks.items():
                assert track.dtype == np.float64, f"track '{name}' must be float64, found {track.dtype}"
                assert track.shape[:1] == (samples,), (
                    f"track '{name}' must have {samples} rows like steps, found shape {track.shape}"
                )
                if name in self.component.tracks:
                    assert track.shape == (samples, 3), (
                        f"track '{name}' must have shape ({samples}, 3), found {track.shape}"
                    )

    def test_time_increases(self) -> None:
        """Steps and times increase from sample to sample."""
        for outcome in self._simulate(self._all()):
            assert (np.diff(outcome.steps) > 0).all(), f"steps must increase, found {outcome.steps}"
            assert (np.diff(outcome.times) > 0).all(), f"times must increase, found {outcome.times}"

    def test_positions_are_finite_unless_the_simulation_diverged(self) -> None:
        """Positions are finite before the step of the divergence."""
        for outcome in self._simulate(self._all()):
            sound = outcome.steps < (np.inf if outcome.diverged_at is None else outcome.diverged_at)
            for name, track in outcome.tracks.items():
                assert np.isfinite(track[sound]).all(), (
                    f"track '{name}' must be finite before diverged_at = {outcome.diverged_at}"
                )

    def test_divergence_is_reported(self) -> None:
        """A diverged outcome has the step of the divergence, from which positions are NaN."""
        for outcome in self._simulate(self.diverging()):
            assert outcome.diverged_at is not None, "the outcomes of diverging() must have diverged_at"
            lost = outcome.steps >= outcome.diverged_at
            for name, track in outcome.tracks.items():
                assert np.isnan(track[lost]).all(), (
                    f"track '{name}' must be NaN from diverged_at = {outcome.diverged_at}"
                )

    def test_a_simulation_can_be_repeated(self) -> None:
        """Repeated simulations have equal outcomes, to the last bit."""
        _assert_same(
            self._simulate(self._all()),
            self._simulate(self._all()),
            "two simulations of the same designs differ",
        )

    def test_a_batch_equals_its_members_one_by_one(self) -> None:
        """An outcome does not depend on the batch or its order, nor on a diverging design in it."""
        together = self._simulate(self._all())
        _assert_same(
            together,
            [self._simulate([design])[0] for design in self._all()],
            "outcomes in a batch differ from those of the designs one by one",
        )
        _assert_same(
            together,
            self._simulate(self._all()[::-1])[::-1],
            "outcomes depend on the order of the designs in a batch",
        )

    def test_any_number_of_threads_may_call_at_once(self) -> None:
        """Outcomes are the same if several threads simulate in parallel, to the last bit."""
        designs = self._all() * 4
        with ThreadPoolExecutor(4) as pool:
            outcomes = list(pool.map(lambda design: self._simulate([design])[0], designs))
        _assert_same(
            outcomes,
            list(self._simulate(self._all())) * 4,
            "outcomes differ if several threads simulate in parallel; do not share buffers",
        )

    def test_recording_more_tracks_changes_nothing(self) -> None:
        """A track recorded alone equals the track recorded with others, before a divergence."""
        whole = self._simulate(self._all())
        for track in self.record().tracks:
            alone = self._simulate(self._all(), attrs.evolve(self.record(), tracks=(track,)))
            for one, all_ in zip(alone, whole, strict=True):
                self._assert_unchanged(
                    one,
                    attrs.evolve(all_, tracks={track: all_.tracks[track]}),
                    f"track '{track}' recorded alone differs from the same track recorded with others",
                )

    def test_recording_more_samples_changes_nothing(self) -> None:
        """A sample recorded alone equals the sample recorded with others, before a divergence."""
        every_sample = attrs.evolve(self.record(), samples=None, initial=False)
        whole = self._simulate(self._all(), every_sample)
        last = min(len(outcome.steps) for outcome in whole if _has_started(outcome)) - 1
        for sample in sorted({0, last // 2, last}):
            record = attrs.evolve(every_sample, samples=(sample,))
            for one, all_ in zip(self._simulate(self._all(), record), whole, strict=True):
                if _has_started(all_):
                    self._assert_unchanged(
                        one,
                        _rows(all_, slice(sample, sample + 1)),
                        f"sample {sample} recorded alone differs from the same sample recorded with others",
                    )

    def test_the_initial_state_is_one_more_row(self) -> None:
        """``Record.initial`` adds one row for the state before the first step, and changes nothing else."""
        whole = self._simulate(self._all(), attrs.evolve(self.record(), initial=False))
        more = self._simulate(self._all(), attrs.evolve(self.record(), initial=True))
        for one, all_ in zip(more, whole, strict=True):
            if _has_started(all_):
                assert one.steps[0] == 0, f"the initial state must have step 0, found {one.steps[0]}"
                assert one.times[0] == 0, f"the initial state must have time 0, found {one.times[0]}"
                assert same_outcome(_rows(one, slice(1, None)), all_), (
                    "recording the initial state changes the other samples"
                )

    def test_sampling_more_often_changes_nothing(self) -> None:
        """Outcomes recorded at different intervals agree in their common steps, before a divergence."""
        often = self._simulate(self._all(), Record(self.record().tracks))
        every = float(often[0].times[-1]) / 3
        seldom = self._simulate(self._all(), Record(self.record().tracks, every=every))
        for one, all_ in zip(seldom, often, strict=True):
            assert set(one.steps) <= set(all_.steps), (
                "the record of every step must contain every sampled step"
            )
            self._assert_unchanged(
                one,
                _rows(all_, np.isin(all_.steps, one.steps)),
                f"samples differ if they are recorded every {every} s instead of after every step",
            )

    def test_whole_designs_diverge_whatever_is_recorded(self) -> None:
        """``for_whole_designs`` changes only which divergences count; those do not depend on the record."""
        component = self.component
        if not isinstance(component, SupportsWholeDesigns):
            return
        whole = component.for_whole_designs()
        assert isinstance(whole, type(component)), (
            f"for_whole_designs() must return a {type(component).__name__}, found {type(whole).__name__}"
        )
        most = Record(tuple(component.tracks))
        expected = [outcome.diverged_at for outcome in whole.simulate(self._all(), most)]
        for record in (most, attrs.evolve(most, tracks=most.tracks[:1]), attrs.evolve(most, samples=(0,))):
            outcomes = whole.simulate(self._all(), record)
            found = [outcome.diverged_at for outcome in outcomes]
            assert found == expected, (
                f"divergences of whole designs depend on what is recorded: {found} with {record}, {expected} "
                f"with {most}"
            )
            for one, all_ in zip(self._simulate(self._all(), record), outcomes, strict=True):
                self._assert_unchanged(
                    one, all_, "samples before a divergence differ from those of whole designs"
                )

    def test_keys_are_bytes_and_equal_for_equal_designs(self) -> None:
        """Keys are bytes, and a copy of a design has the same key."""
        for design in self._all():
            copy = Design({role: array.copy() for role, array in design.roles.items()})
            key = self.component.key(design, self.record())
            assert isinstance(key, bytes), f"key() must return bytes, found {type(key).__name__}"
            assert key == self.component.key(copy, self.record()), (
                "key() differs for a copy of the design; compute it from the values of the arrays"
            )

    def test_equal_keys_mean_equal_outcomes(self) -> None:
        """Designs and records with equal keys have equal outcomes."""
        known: dict[bytes, Outcome] = {}
        shorter = attrs.evolve(self.record(), samples=(0,))
        for record in (self.record(), shorter):
            for design, outcome in zip(self._all(), self._simulate(self._all(), record), strict=True):
                first = known.setdefault(self.component.key(design, record), outcome)
                assert same_outcome(first, outcome), (
                    "two outcomes with the same key differ; the key must contain everything that affects them"
                )

    def test_the_duration_is_the_time_of_the_last_step(self) -> None:
        """``duration_of`` is the time of the last sample if every step is sampled, to the last bit."""
        if not isinstance(self.component, SupportsDuration):
            return
        every_step = Record(tuple(self.component.tracks))
        for design, outcome in zip(self._all(), self._simulate(self._all(), every_step), strict=True):
            duration = self.component.duration_of(design)
            assert isinstance(duration, float), f"expected a float, found {type(duration).__name__}"
            last = float(outcome.times[-1]) if len(outcome.times) else 0.0
            assert duration == last, f"expected the time of the last step, {last} s, found {duration} s"

    def test_the_suggested_objective_is_a_table_with_a_name(self) -> None:
        """``objective_for`` returns the same table every time, with the name of an objective."""
        if not isinstance(self.component, SupportsObjective):
            return
        first, second = (self.component.objective_for(self.designs()) for _ in range(2))
        name = first.get("name")
        assert isinstance(name, str), f"expected a table with the name of an objective, found {name!r}"
        assert first == second, "objective_for() returns different objectives for the same designs"

    def test_variants_are_scored_by_the_same_objective(self) -> None:
        """A variant has a name, and the tracks and number of samples of the unchanged simulation."""
        record = self.record()
        for design in self.designs():
            [unchanged] = self._simulate([design])
            for variant in self._variants(design):
                assert isinstance(variant, Variant), f"expected a Variant, found {type(variant).__name__}"
                assert variant.name.strip(), "a variant requires a name that is not empty"
                assert variant.name != UNCHANGED, (
                    f"the name '{UNCHANGED}' is reserved for the unchanged design"
                )
                variant.simulator.check(variant.record)
                [outcome] = variant.simulator.simulate([variant.design], variant.record)
                assert variant.record.tracks == record.tracks, (
                    f"variant '{variant.name}' must record the tracks {record.tracks}"
                )
                assert variant.record.initial == record.initial, (
                    f"variant '{variant.name}' must record with initial = {record.initial}"
                )
                assert (variant.record.samples is None) == (record.samples is None), (
                    f"variant '{variant.name}' must select samples if and only if the given record does"
                )
                if record.samples is not None and _has_started(outcome) and _has_started(unchanged):
                    n_samples = len(unchanged.steps)
                    assert len(outcome.steps) == n_samples, (
                        f"variant '{variant.name}' must have {n_samples} samples, found {len(outcome.steps)}"
                    )

    def test_the_same_design_has_the_same_variants(self) -> None:
        """A design has the same variants every time, to the last bit."""
        for design in self.designs():
            first, second = self._variants(design), self._variants(design)
            for one, other in zip(first, second, strict=True):
                assert (one.name, one.simulator, one.record) == (other.name, other.simulator, other.record), (
                    "variants() returns different variants for the same design"
                )
                assert same_arrays(one.design.roles, other.design.roles), (
                    f"variant '{one.name}' has a different design each time; seed its random generator"
                )

    def test_each_format_gives_the_same_bytes_twice(self) -> None:
        """An export is the same every time; omitted settings are listed as text."""
        component = self.component
        assert hasattr(component, "formats") == hasattr(component, "export"), (
            "a simulator that exports designs must have both formats and export()"
        )
        if not isinstance(component, SupportsExport):
            return
        for format_ in component.formats:
            assert re.fullmatch("[a-z0-9]+", format_), (
                f"formats must be file extensions of letters a-z and digits, found '{format_}'"
            )
            assert format_ != "json", "the format 'json' is reserved for the champion.json of a run"
            for design in self.designs():
                first, second = (component.export(design, format_) for _ in range(2))
                assert isinstance(first, Export), f"expected an Export, found {type(first).__name__}"
                found = type(first.data).__name__
                assert isinstance(first.data, bytes), f"{format_}: data must be bytes, found {found}"
                assert first.data, f"{format_}: data must not be empty"
                assert all(isinstance(entry, str) and entry.strip() for entry in first.left_out), (
                    f"{format_}: left_out must contain strings that are not empty, found {first.left_out}"
                )
                assert first == second, f"{format_}: two exports of the same design differ"

    def test_a_geometry_has_frames_of_meshes(self) -> None:
        """A geometry has at most the requested frames, starts at rest, and consists of visible meshes."""
        asked = [(frames, geometry) for frames in (1, 2, 7) for geometry in self._geometries(frames)]
        for frames, geometry in asked:
            n_frames = len(geometry.times)
            assert 1 <= n_frames <= frames, f"expected 1 to {frames} frames, found {n_frames}"
            assert geometry.times[0] == 0.0, f"times must start at 0, found {geometry.times[0]}"
            assert (np.diff(geometry.times) > 0).all(), f"times must increase, found {geometry.times}"
            assert geometry.parts, "a geometry must have at least one part"
            for part in geometry.parts:
                assert_is_mesh(part, n_frames)
            for name, track in geometry.tracks.items():
                assert name in self.component.tracks, f"unknown track '{name}' in a geometry"
                assert track.shape == (n_frames, 3), (
                    f"track '{name}' must have shape ({n_frames}, 3), found {track.shape}"
                )
                assert np.isfinite(track).all(), f"track '{name}' must be finite"

    def test_one_frame_is_the_first_of_many(self) -> None:
        """The single frame of a geometry equals the first of several, to the last bit."""
        for one, many in zip(self._geometries(1), self._geometries(5), strict=True):
            for part, moving in zip(one.parts, many.parts, strict=True):
                assert np.array_equal(part.vertices[0], moving.vertices[0]), (
                    f"{part.name}: the vertices of a single frame differ from those of the first of 5 frames"
                )
                assert np.array_equal(part.faces, moving.faces), (
                    f"{part.name}: the faces of a single frame differ from those of 5 frames"
                )

    def _geometries(self, frames: int) -> list[Geometry]:
        if not isinstance(self.component, SupportsGeometry):
            return []
        return [self.component.geometry(design, frames) for design in self.designs()]

    def test_a_random_controller_depends_on_the_generator(self) -> None:
        """The same random state gives the same controller, a different state a different one."""
        for design in self.designs() if isinstance(self.component, SupportsRandomControllers) else []:
            one, again, other = (self._drawn(design, seed).roles for seed in (1, 1, 2))
            assert same_arrays(one, again), "random_controller() differs for the same random state"
            assert not same_arrays(one, other), "random_controller() must draw from the given generator"

    def test_a_random_controller_keeps_the_body(self) -> None:
        """The roles are the same, at least one is unchanged, and the design can be simulated."""
        for design in self.designs() if isinstance(self.component, SupportsRandomControllers) else []:
            drawn = self._drawn(design, 1)
            assert isinstance(drawn, Design), f"expected a Design, found {type(drawn).__name__}"
            assert set(drawn.roles) == set(design.roles), (
                f"random_controller() must keep the roles {sorted(design.roles)}, found {sorted(drawn.roles)}"
            )
            assert self._kept(design), "random_controller() must keep the body: all roles have changed"
            assert len(self._simulate([drawn])) == 1, (
                "a design with a random controller must have one outcome"
            )

    def test_bodies_of_the_same_shape_get_the_same_random_controller(self) -> None:
        """The random controller depends on the shape of a body, not on its materials."""
        known: dict[str, np.ndarray] = {}
        for design in self.designs() if isinstance(self.component, SupportsRandomControllers) else []:
            drawn = self._drawn(design, 1)
            shapes = repr(sorted((role, array.shape) for role, array in design.roles.items()))
            for role in sorted(set(drawn.roles) - self._kept(design)):
                first = known.setdefault(f"{role} of {shapes}", drawn.roles[role])
                assert same_arrays({role: first}, {role: drawn.roles[role]}), (
                    f"role '{role}' differs between bodies of the same shape for the same random state"
                )

    def test_published_bodies_can_be_simulated(self) -> None:
        """Published bodies have different names, are the same every time, and can be simulated."""
        first, second = (
            [*self.component.published()] if isinstance(self.component, SupportsPublished) else []
            for _ in "12"
        )
        labels = [label for label, _ in first]
        assert all(isinstance(label, str) and label.strip() for label in labels), (
            f"published bodies require names that are not empty, found {labels}"
        )
        assert len(set(labels)) == len(labels), f"published bodies require different names, found {labels}"
        for (label, design), (same_label, same) in zip(first, second, strict=True):
            missing = sorted(set(self.component.requires) - set(design.roles))
            assert not missing, f"published body '{label}' must have the required roles, missing: {missing}"
            assert label == same_label, "published() returns different names each time"
            assert same_arrays(design.roles, same.roles), f"published body '{label}' differs each time"
            assert len(self._simulate([design])) == 1, f"published body '{label}' must have one outcome"

    def _drawn(self, design: Design, seed: int) -> Design:
        assert isinstance(self.component, SupportsRandomControllers)
        return self.component.random_controller(design, np.random.default_rng(seed))

    def _kept(self, design: Design) -> set[str]:
        """Return the roles that random controllers do not change."""
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

    def _assert_unchanged(self, less: Outcome, more: Outcome, problem: str) -> None:
        """Fail unless *less*, recorded alone, equals the same samples of an outcome with more of them.

        What diverges in *more* may be out of reach of the samples of *less*, if the simulator offers whole
        designs.
        """
        may_ignore = isinstance(self.component, SupportsWholeDesigns) and more.diverged_at is not None
        assert same_outcome(less, more) or (may_ignore and _is_ignored_divergence(less, more)), problem

    def _all(self) -> list[Design]:
        return [*self.designs(), *self.diverging()]

    def _simulate(self, designs: Sequence[Design], record: Record | None = None) -> Sequence[Outcome]:
        return self.component.simulate(designs, record or self.record())


def _assert_same(outcomes: Sequence[Outcome], others: Sequence[Outcome], problem: str) -> None:
    for one, other in zip(outcomes, others, strict=True):
        assert same_outcome(one, other), problem


def _has_started(outcome: Outcome) -> bool:
    return outcome.diverged_at != 0


def _is_ignored_divergence(less: Outcome, more: Outcome) -> bool:
    """Return whether *less* equals *more*, which diverges, until then, and diverges later or not at all."""
    step = more.diverged_at or 0
    is_later = less.diverged_at is None or less.diverged_at > step
    one, other = (attrs.evolve(_rows(each, each.steps < step), diverged_at=None) for each in (less, more))
    return is_later and np.array_equal(less.steps, more.steps) and same_outcome(one, other)


def _rows(outcome: Outcome, rows: slice | np.ndarray) -> Outcome:
    """Return *outcome* with a selection of its samples."""
    return attrs.evolve(
        outcome,
        steps=outcome.steps[rows],
        times=outcome.times[rows],
        tracks={name: track[rows] for name, track in outcome.tracks.items()},
    )
