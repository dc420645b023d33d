import itertools
import time
from collections.abc import Callable, Sequence
from typing import Any, ClassVar

import attrs
import numpy as np
import pytest
from contracts import name_of
from numpy.typing import NDArray

from evoframe import ConfigurationError, Design, Export, Geometry, GeometryPart, Outcome, Record, Variant
from evoframe.testing import SimulatorContract

ACCEPTED = "test_a_record_of_its_tracks_is_accepted"
TRACK = "test_an_unknown_track_is_refused"
END = "test_a_sample_after_the_end_is_refused"
UNTIL = "test_a_simulation_that_ends_before_record_until_is_refused"
ONLY_UNTIL = "test_record_until_does_not_change_outcomes"
EACH = "test_each_design_has_an_outcome"
ARRAYS = "test_outcomes_have_the_promised_arrays"
TIME = "test_time_increases"
FINITE = "test_positions_are_finite_unless_the_simulation_diverged"
DIVERGENCE = "test_divergence_is_reported"
REPEATED = "test_a_simulation_can_be_repeated"
BATCH = "test_a_batch_equals_its_members_one_by_one"
THREADS = "test_any_number_of_threads_may_call_at_once"
TRACKS = "test_recording_more_tracks_changes_nothing"
SAMPLES = "test_recording_more_samples_changes_nothing"
INITIAL = "test_the_initial_state_is_one_more_row"
OFTEN = "test_sampling_more_often_changes_nothing"
WHOLE = "test_whole_designs_diverge_whatever_is_recorded"
KEYS = "test_keys_are_bytes_and_equal_for_equal_designs"
EQUAL_KEYS = "test_equal_keys_mean_equal_outcomes"
VARIANTS = "test_variants_are_scored_by_the_same_objective"
SAME_VARIANTS = "test_the_same_design_has_the_same_variants"
GEOMETRY = "test_a_geometry_has_frames_of_meshes"
FIRST_FRAME = "test_one_frame_is_the_first_of_many"
DURATION = "test_the_duration_is_the_time_of_the_last_step"
OBJECTIVE = "test_the_suggested_objective_is_a_table_with_a_name"
FORMATS = "test_each_format_gives_the_same_bytes_twice"
DRAWN = "test_a_random_controller_depends_on_the_generator"
BODY = "test_a_random_controller_keeps_the_body"
SHARED = "test_bodies_of_the_same_shape_get_the_same_random_controller"
PUBLISHED = "test_published_bodies_can_be_simulated"

STEPS, STEP = 12, 0.01


@attrs.frozen
class Spring:
    """A valid simulator of a weight on a spring, and the base of the broken ones.

    The role ``spring`` is stiffness and damping; a third number is its color, which does not matter. Without
    stiffness, the simulation diverges at step 0.
    """

    requires: ClassVar[tuple[str, ...]] = ("spring",)
    tracks: ClassVar[tuple[str, ...]] = ("weight", "middle")

    def check(self, record: Record) -> None:
        for track in record.tracks:
            if track not in self.tracks:
                raise ConfigurationError(f"unknown track '{track}'")
        if record.samples and max(record.samples) >= len(self.sampled(record)):
            raise ConfigurationError(f"expected at most {len(self.sampled(record))} samples")
        if record.until > self.kept(record)[-1] * STEP:
            raise ConfigurationError(f"the simulation ends before {record.until} s")

    def simulate(self, designs: Sequence[Design], record: Record) -> Sequence[Outcome]:
        return [self.one(design, record) for design in designs]

    def key(self, design: Design, record: Record) -> Any:
        return design.roles["spring"][:2].tobytes() + repr(record).encode()

    def one(self, design: Design, record: Record) -> Outcome:
        positions, diverged_at = self.positions(design)
        steps = self.kept(record)[: 0 if diverged_at == 0 else None]
        tracks = {"weight": positions[steps], "middle": positions[steps] / 2}
        recorded = {name: tracks[name] for name in record.tracks}
        times = steps.astype(np.float64) * STEP
        return Outcome(steps, times, recorded, diverged_at)

    def positions(self, design: Design) -> tuple[NDArray[np.float64], int | None]:
        stiffness, damping = design.roles["spring"][:2]
        positions, speed = np.zeros((STEPS + 1, 3)), 1.0
        if stiffness == 0:
            return positions, 0
        for step in range(1, STEPS + 1):
            speed -= STEP * (stiffness * positions[step - 1, 2] + damping * speed)
            positions[step] = positions[step - 1] + (0, 0, STEP * speed)
            if abs(positions[step, 2]) > 10:
                positions[step:] = np.nan
                return positions, step
        return positions, None

    def sampled(self, record: Record) -> NDArray[np.int64]:
        """Return the steps of all samples."""
        steps = [1]
        for step in range(2, STEPS + 1):
            if (step - steps[-1]) * STEP >= record.every - 1e-12:
                steps.append(step)
        return np.array(steps, dtype=np.int64)

    def kept(self, record: Record) -> NDArray[np.int64]:
        steps = self.sampled(record)
        steps = steps if record.samples is None else steps[list(record.samples)]
        return np.append(0, steps) if record.initial else steps


def spring(stiffness: float, damping: float, color: float = 0.0) -> Design:
    return Design({"spring": np.array([stiffness, damping, color])})


class SpringContract(SimulatorContract):
    def designs(self) -> Sequence[Design]:
        return [spring(1.0, 0.0), spring(1.0, 0.0, color=1.0), spring(50.0, 0.5), spring(1.0, 0.1)]

    def diverging(self) -> Sequence[Design]:
        return [spring(1e6, -1.0), spring(0.0, 0.0)]


class TestSpring(SpringContract):
    component = Spring()


class TestSpringWithinASelection(SpringContract):
    component = Spring()

    def record(self) -> Record:
        return Record(("weight",), every=0.02, samples=(1, 2, 4), initial=True)


@attrs.frozen
class Offering(Spring):
    """A valid simulator with formats, variants and geometries, and the base of the broken ones."""

    strength: float = 1.0
    formats: ClassVar[tuple[str, ...]] = ("txt",)

    def duration_of(self, design: Design) -> Any:
        return STEPS * STEP if design.roles["spring"][0] else 0.0

    def objective_for(self, designs: Sequence[Design]) -> Any:
        return {"name": "rise"}

    def export(self, design: Design, format_: str) -> Any:
        return Export(repr(design.roles["spring"].tolist()).encode(), ("color",))

    def variants(self, design: Design, record: Record) -> Sequence[Any]:
        return [
            Variant("stronger", Offering(strength=2.0), design, record),
            *(Variant("jittered", self, drawn, record) for drawn in self.drawn(design)),
        ]

    def drawn(self, design: Design) -> Sequence[Design]:
        draws = np.random.default_rng(1).uniform(0.99, 1.01, 3)
        return [design.with_role("spring", design.roles["spring"] * draw) for draw in draws]

    def geometry(self, design: Design, frames: int) -> Geometry:
        positions, _ = self.positions(design)
        heights = positions[np.isfinite(positions[:, 2])][:frames]
        square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], np.float64)
        corners = np.array([[0, 1, 2, 3]])
        part = GeometryPart("weight", "#d55e00", 1.0, heights[:, None] + square, corners)
        return Geometry(np.arange(float(len(heights))), (part,), {"weight": heights})


class TestOffering(SpringContract):
    component = Offering()


class TestOfferingWithinASelection(SpringContract):
    component = Offering()

    def record(self) -> Record:
        return Record(("weight",), every=0.02, samples=(1, 2, 4), initial=True)


class ForgetsThatItCannotStart(Offering):
    def duration_of(self, design: Design) -> Any:
        return STEPS * STEP


class CountsSteps(Offering):
    def duration_of(self, design: Design) -> Any:
        return STEPS


class SuggestsNothing(Offering):
    def objective_for(self, designs: Sequence[Design]) -> Any:
        return {}


class SuggestsAnotherEachTime(Offering):
    calls: ClassVar[Any] = itertools.count()

    def objective_for(self, designs: Sequence[Design]) -> Any:
        return {"name": f"rise-{next(self.calls)}"}


class DrawsAnew(Offering):
    calls: ClassVar[Any] = itertools.count()

    def drawn(self, design: Design) -> Sequence[Design]:
        return [design.with_role("spring", design.roles["spring"] + next(self.calls))]


class NamelessVariant(Offering):
    def variants(self, design: Design, record: Record) -> Sequence[Any]:
        return [Variant(" ", self, design, record)]


class VariesNothing(Offering):
    def variants(self, design: Design, record: Record) -> Sequence[Any]:
        return [Variant("unchanged", self, design, record)]


class VariantOfTooManySamples(Offering):
    def variants(self, design: Design, record: Record) -> Sequence[Any]:
        return [Variant("finer", self, design, attrs.evolve(record, samples=(0, 1, 2, 3)))]


class VariantOfAnotherTrack(Offering):
    def variants(self, design: Design, record: Record) -> Sequence[Any]:
        return [Variant("middle", self, design, attrs.evolve(record, tracks=("middle",)))]


class VariantThatIsRefused(Offering):
    def variants(self, design: Design, record: Record) -> Sequence[Any]:
        return [Variant("later", self, design, attrs.evolve(record, until=1e9))]


class Redrawn(Offering):
    """Draws like `Offering`; subclasses change one detail."""

    def geometry(self, design: Design, frames: int) -> Geometry:
        return self.changed(super().geometry(design, frames))

    def changed(self, geometry: Geometry) -> Geometry:
        parts = tuple(self.part(part) for part in geometry.parts)
        return attrs.evolve(geometry, parts=parts)

    def part(self, part: GeometryPart) -> GeometryPart:
        return part


class ShowsNothing(Redrawn):
    def changed(self, geometry: Geometry) -> Geometry:
        return attrs.evolve(geometry, parts=())


class DrawsAllTheTime(Offering):
    def geometry(self, design: Design, frames: int) -> Geometry:
        return super().geometry(design, 12)


class DrawsFromTheFirstStep(Redrawn):
    def changed(self, geometry: Geometry) -> Geometry:
        return attrs.evolve(geometry, times=geometry.times + STEP)


class DrawsAnUnknownTrack(Redrawn):
    def changed(self, geometry: Geometry) -> Geometry:
        return attrs.evolve(geometry, tracks={"wheel": geometry.tracks["weight"]})


class DrawsNamedColors(Redrawn):
    def part(self, part: GeometryPart) -> GeometryPart:
        return attrs.evolve(part, colour="red")


class DrawsInvisibly(Redrawn):
    def part(self, part: GeometryPart) -> GeometryPart:
        return attrs.evolve(part, opacity=0.0)


class DrawsWithoutACorner(Redrawn):
    def part(self, part: GeometryPart) -> GeometryPart:
        return attrs.evolve(part, vertices=part.vertices[:, :3])


class DrawsTriangles(Redrawn):
    def part(self, part: GeometryPart) -> GeometryPart:
        return attrs.evolve(part, faces=part.faces[:, :3])


class DrawsNowhere(Redrawn):
    def part(self, part: GeometryPart) -> GeometryPart:
        return attrs.evolve(part, vertices=part.vertices * np.nan)


class DrawsTheEndAsSingleFrame(Offering):
    def geometry(self, design: Design, frames: int) -> Geometry:
        geometry = super().geometry(design, frames)
        if frames > 1:
            return geometry
        [part] = geometry.parts
        return attrs.evolve(geometry, parts=(attrs.evolve(part, vertices=part.vertices + 1.0),))


class ExportsText(Offering):
    def export(self, design: Design, format_: str) -> Any:
        return Export("text", ())  # type: ignore[arg-type]


class ExportsNothing(Offering):
    def export(self, design: Design, format_: str) -> Any:
        return Export(b"", ())


class ExportsTheCall(Offering):
    calls: ClassVar[Any] = itertools.count()

    def export(self, design: Design, format_: str) -> Any:
        return Export(str(next(self.calls)).encode())


class LeavesOutWithoutText(Offering):
    def export(self, design: Design, format_: str) -> Any:
        return Export(b"spring", ("",))


class WritesTheChampionsName(Offering):
    formats = ("json",)


class WritesAPath(Offering):
    formats = ("../txt",)


@attrs.frozen
class Controlled(Spring):
    """A valid simulator with random controllers and published bodies, and the base of the broken ones.

    A second role, ``push``, is the controller; it has no effect on the simulation.
    """

    def random_controller(self, design: Design, rng: np.random.Generator) -> Any:
        return design.with_role("push", rng.uniform(-1.0, 1.0, design.roles["push"].shape))

    def published(self) -> Any:
        return [("soft", pushed(spring(0.1, 0.0))), ("stiff", pushed(spring(1.0, 0.0)))]


def pushed(design: Design) -> Design:
    return design.with_role("push", np.zeros(2))


class ControlledContract(SpringContract):
    def designs(self) -> Sequence[Design]:
        return [pushed(design) for design in super().designs()]


class TestControlled(ControlledContract):
    component = Controlled()


class DrawsWithoutTheGenerator(Controlled):
    calls: ClassVar[Any] = itertools.count()

    def random_controller(self, design: Design, rng: np.random.Generator) -> Any:
        return design.with_role("push", np.array([next(self.calls), 0.0]))


class DrawsNothing(Controlled):
    def random_controller(self, design: Design, rng: np.random.Generator) -> Any:
        return design


class DrawsTheBodyToo(Controlled):
    def random_controller(self, design: Design, rng: np.random.Generator) -> Any:
        drawn = super().random_controller(design, rng)
        return drawn.with_role("spring", rng.uniform(0.1, 1.0, 3))


class DrawsAnotherRole(Controlled):
    def random_controller(self, design: Design, rng: np.random.Generator) -> Any:
        return design.with_role("wind", rng.uniform(-1.0, 1.0, 2))


class DrawsByStiffness(Controlled):
    """Draws stronger controllers for stiffer springs."""

    def random_controller(self, design: Design, rng: np.random.Generator) -> Any:
        drawn = super().random_controller(design, rng)
        return drawn.with_role("push", drawn.roles["push"] * design.roles["spring"][0])


class PublishesOneNameTwice(Controlled):
    def published(self) -> Any:
        return [("soft", pushed(spring(0.1, 0.0))), ("soft", pushed(spring(1.0, 0.0)))]


class PublishesWithoutAName(Controlled):
    def published(self) -> Any:
        return [(" ", pushed(spring(0.1, 0.0)))]


class PublishesNoBody(Controlled):
    def published(self) -> Any:
        return [("soft", Design({"push": np.zeros(2)}))]


class PublishesAnotherEachTime(Controlled):
    calls: ClassVar[Any] = itertools.count(1)

    def published(self) -> Any:
        return [("soft", pushed(spring(float(next(self.calls)), 0.0)))]


@attrs.frozen
class Shortsighted(Spring):
    """A valid simulator that ignores divergences after the last sample, and the base of the broken ones."""

    whole: bool = False

    def for_whole_designs(self) -> Any:
        return attrs.evolve(self, whole=True)

    def one(self, design: Design, record: Record) -> Outcome:
        outcome = super().one(design, record)
        if not outcome.diverged_at or self.whole or not len(outcome.steps):
            return outcome
        return self.judged(design, outcome, record)

    def judged(self, design: Design, outcome: Outcome, record: Record) -> Outcome:
        assert outcome.diverged_at is not None
        seen = outcome.diverged_at <= outcome.steps[-1]
        return outcome if seen else attrs.evolve(outcome, diverged_at=None)


class ShortsightedContract(SpringContract):
    def diverging(self) -> Sequence[Design]:
        return [*super().diverging(), spring(1e5, -1.0), spring(6e4, -1.0)]


class TestShortsighted(ShortsightedContract):
    component = Shortsighted()


class ShortsightedWithoutWholeDesigns(Spring):
    """Judges a divergence by the samples, but does not offer whole designs."""

    def one(self, design: Design, record: Record) -> Outcome:
        outcome = super().one(design, record)
        if outcome.diverged_at and outcome.diverged_at > outcome.steps[-1]:
            return attrs.evolve(outcome, diverged_at=None)
        return outcome


class DivergesEarlierWithFewerSamples(Shortsighted):
    def judged(self, design: Design, outcome: Outcome, record: Record) -> Outcome:
        return outcome if len(outcome.steps) > 1 else attrs.evolve(outcome, diverged_at=1)


class DisturbedBeforeADivergence(Shortsighted):
    def judged(self, design: Design, outcome: Outcome, record: Record) -> Outcome:
        return changed(super().judged(design, outcome, record), lambda track: track + len(outcome.steps))


class DisturbedWithoutDivergence(Shortsighted):
    def one(self, design: Design, record: Record) -> Outcome:
        return changed(super().one(design, record), lambda track: track + len(record.samples or ()))


class NothingIsWhole(Shortsighted):
    def for_whole_designs(self) -> Any:
        return self


class WholeIsAnotherSimulator(Shortsighted):
    def for_whole_designs(self) -> Any:
        return Spring()


class WholeMovesOtherwise(Shortsighted):
    def one(self, design: Design, record: Record) -> Outcome:
        return changed(super().one(design, record), lambda track: track + self.whole)


class IgnoresUntil(Spring):
    def check(self, record: Record) -> None:
        super().check(attrs.evolve(record, until=0.0))


class StopsAtUntil(Spring):
    def kept(self, record: Record) -> NDArray[np.int64]:
        steps = super().kept(record)
        return steps[steps * STEP <= record.until] if record.until else steps


class AcceptsAnyTrack(Spring):
    def check(self, record: Record) -> None:
        pass


class RefusesEverything(Spring):
    def check(self, record: Record) -> None:
        raise ConfigurationError("no")


class ForgetsTheLast(Spring):
    def simulate(self, designs: Sequence[Design], record: Record) -> Sequence[Outcome]:
        return super().simulate(designs[:-1], record)


class NoEmptyBatch(Spring):
    def simulate(self, designs: Sequence[Design], record: Record) -> Sequence[Outcome]:
        return super().simulate(designs or [spring(1.0, 0.0)], record)


class AddsOutcomes(Spring):
    """Returns outcomes that depend on the batch."""

    def simulate(self, designs: Sequence[Design], record: Record) -> Sequence[Outcome]:
        outcomes = super().simulate(designs, record)
        return [changed(outcome, lambda track: track + len(designs)) for outcome in outcomes]


class StopsAtADivergence(Spring):
    def simulate(self, designs: Sequence[Design], record: Record) -> Sequence[Outcome]:
        outcomes = super().simulate(designs, record)
        return [outcome if i == 0 else attrs.evolve(outcomes[0]) for i, outcome in enumerate(outcomes)]


class SharedBuffer(Spring):
    buffer: ClassVar[NDArray[np.float64]] = np.zeros((STEPS + 1, 3))

    def positions(self, design: Design) -> tuple[NDArray[np.float64], int | None]:
        positions, diverged_at = super().positions(design)
        self.buffer[:] = positions
        time.sleep(0.01)
        return self.buffer.copy(), diverged_at


class Noisy(Spring):
    def one(self, design: Design, record: Record) -> Outcome:
        noise = np.random.default_rng().normal()
        return changed(super().one(design, record), lambda track: track + noise)


class DisturbedByTracks(Spring):
    def one(self, design: Design, record: Record) -> Outcome:
        return changed(super().one(design, record), lambda track: track + len(record.tracks))


class DisturbedBySamples(Spring):
    def one(self, design: Design, record: Record) -> Outcome:
        return changed(super().one(design, record), lambda track: track + len(record.samples or ()))


class DisturbedByRate(Spring):
    def one(self, design: Design, record: Record) -> Outcome:
        return changed(super().one(design, record), lambda track: track + record.every)


class IgnoresInitial(Spring):
    def one(self, design: Design, record: Record) -> Outcome:
        return super().one(design, attrs.evolve(record, initial=False))


class HidesDivergence(Spring):
    def one(self, design: Design, record: Record) -> Outcome:
        return attrs.evolve(super().one(design, record), diverged_at=None)


class HidesNaN(Spring):
    def one(self, design: Design, record: Record) -> Outcome:
        return changed(super().one(design, record), np.nan_to_num)


class SinglePrecision(Spring):
    def one(self, design: Design, record: Record) -> Outcome:
        return changed(super().one(design, record), lambda track: track.astype(np.float32))


class AllTracksAlways(Spring):
    def one(self, design: Design, record: Record) -> Outcome:
        return super().one(design, attrs.evolve(record, tracks=self.tracks))


class LosesASample(Spring):
    def kept(self, record: Record) -> NDArray[np.int64]:
        return super().kept(record)[1:]


class OnlyHeights(Spring):
    def one(self, design: Design, record: Record) -> Outcome:
        return changed(super().one(design, record), lambda track: track[:, 2:])


class StandsStill(Spring):
    def one(self, design: Design, record: Record) -> Outcome:
        outcome = super().one(design, record)
        return attrs.evolve(outcome, times=outcome.times * 0)


class KeyOfText(Spring):
    def key(self, design: Design, record: Record) -> Any:
        return super().key(design, record).hex()


class KeyOfIdentity(Spring):
    def key(self, design: Design, record: Record) -> Any:
        return id(design.roles["spring"]).to_bytes(8, "big") + repr(record).encode()


class KeyWithoutDamping(Spring):
    def key(self, design: Design, record: Record) -> Any:
        return design.roles["spring"][:1].tobytes() + repr(record).encode()


class KeyWithoutRecord(Spring):
    def key(self, design: Design, record: Record) -> Any:
        return design.roles["spring"].tobytes()


def changed(outcome: Outcome, change: Callable[[NDArray[np.float64]], Any]) -> Outcome:
    return attrs.evolve(outcome, tracks={name: change(track) for name, track in outcome.tracks.items()})


@pytest.mark.parametrize(
    ("component", "law"),
    [
        (AcceptsAnyTrack(), TRACK),
        (AcceptsAnyTrack(), END),
        (IgnoresUntil(), UNTIL),
        (StopsAtUntil(), ONLY_UNTIL),
        (ForgetsTheLast(), EACH),
        (NoEmptyBatch(), EACH),
        (AddsOutcomes(), BATCH),
        (StopsAtADivergence(), BATCH),
        (SharedBuffer(), THREADS),
        (Noisy(), REPEATED),
        (DisturbedByTracks(), TRACKS),
        (DisturbedBySamples(), SAMPLES),
        (DisturbedByRate(), OFTEN),
        (ShortsightedWithoutWholeDesigns(), SAMPLES),
        (IgnoresInitial(), INITIAL),
        (HidesDivergence(), FINITE),
        (HidesDivergence(), DIVERGENCE),
        (HidesNaN(), DIVERGENCE),
        (SinglePrecision(), ARRAYS),
        (OnlyHeights(), ARRAYS),
        (AllTracksAlways(), TRACKS),
        (StandsStill(), TIME),
        (KeyOfText(), KEYS),
        (KeyOfIdentity(), KEYS),
        (KeyWithoutDamping(), EQUAL_KEYS),
        (KeyWithoutRecord(), EQUAL_KEYS),
        (NamelessVariant(), VARIANTS),
        (VariesNothing(), VARIANTS),
        (VariantOfAnotherTrack(), VARIANTS),
        (DrawsAnew(), SAME_VARIANTS),
        (ForgetsThatItCannotStart(), DURATION),
        (CountsSteps(), DURATION),
        (SuggestsNothing(), OBJECTIVE),
        (SuggestsAnotherEachTime(), OBJECTIVE),
        (ShowsNothing(), GEOMETRY),
        (DrawsAllTheTime(), GEOMETRY),
        (DrawsFromTheFirstStep(), GEOMETRY),
        (DrawsAnUnknownTrack(), GEOMETRY),
        (DrawsNamedColors(), GEOMETRY),
        (DrawsInvisibly(), GEOMETRY),
        (DrawsWithoutACorner(), GEOMETRY),
        (DrawsTriangles(), GEOMETRY),
        (DrawsNowhere(), GEOMETRY),
        (DrawsTheEndAsSingleFrame(), FIRST_FRAME),
        (ExportsText(), FORMATS),
        (ExportsNothing(), FORMATS),
        (ExportsTheCall(), FORMATS),
        (LeavesOutWithoutText(), FORMATS),
        (WritesTheChampionsName(), FORMATS),
        (WritesAPath(), FORMATS),
    ],
    ids=name_of,
)
def test_a_broken_simulator_is_caught(component: Any, law: str, breaks: Callable[..., None]) -> None:
    breaks(SpringContract, component, law)


@pytest.mark.parametrize(
    ("component", "law"),
    [
        (DivergesEarlierWithFewerSamples(), SAMPLES),
        (DisturbedBeforeADivergence(), OFTEN),
        (DisturbedWithoutDivergence(), SAMPLES),
        (NothingIsWhole(), WHOLE),
        (WholeIsAnotherSimulator(), WHOLE),
        (WholeMovesOtherwise(), WHOLE),
    ],
    ids=name_of,
)
def test_a_broken_rule_for_divergences_is_caught(
    component: Any, law: str, breaks: Callable[..., None]
) -> None:
    breaks(ShortsightedContract, component, law)


@pytest.mark.parametrize(
    ("component", "law"),
    [
        (DrawsWithoutTheGenerator(), DRAWN),
        (DrawsNothing(), DRAWN),
        (DrawsTheBodyToo(), BODY),
        (DrawsAnotherRole(), BODY),
        (DrawsByStiffness(), SHARED),
        (PublishesOneNameTwice(), PUBLISHED),
        (PublishesWithoutAName(), PUBLISHED),
        (PublishesNoBody(), PUBLISHED),
        (PublishesAnotherEachTime(), PUBLISHED),
    ],
    ids=name_of,
)
def test_a_broken_draw_or_body_is_caught(component: Any, law: str, breaks: Callable[..., None]) -> None:
    breaks(ControlledContract, component, law)


def test_a_lost_sample_is_caught(breaks: Callable[..., None]) -> None:
    record = Record(("weight",), samples=(1, 4))
    breaks(SpringContract, LosesASample(), ARRAYS, record=lambda _: record)


def test_a_record_that_is_refused_is_caught(breaks: Callable[..., None]) -> None:
    breaks(SpringContract, RefusesEverything(), ACCEPTED, error=ConfigurationError)
    breaks(SpringContract, VariantThatIsRefused(), VARIANTS, error=ConfigurationError)


def test_a_variant_that_no_objective_can_score_is_caught(breaks: Callable[..., None]) -> None:
    record = Record(("weight",), samples=(1, 4))
    breaks(SpringContract, VariantOfTooManySamples(), VARIANTS, record=lambda _: record)


def test_too_few_examples_are_caught(breaks: Callable[..., None]) -> None:
    law = "test_there_are_three_examples_with_the_required_roles"
    breaks(SpringContract, Spring(), law, designs=lambda _: [spring(1.0, 0.0)])
    breaks(SpringContract, Spring(), law, designs=lambda _: [Design()] * 3)
    breaks(SimulatorContract, Spring(), law)
