"""The presets other than the paper's, a bending bar and a crawling body, measure bending and locomotion."""

from __future__ import annotations

from typing import Any

import attrs
import numpy as np
import pytest
from numpy.typing import NDArray

import evoframe
from benchmarks.bending import bar, bending, bimorph, first_mode
from evoframe import CONTRACTILE, CONTROLLER, MORPHOLOGY, PASSIVE, Design, RunConfig


@pytest.fixture(scope="module")
def bend() -> RunConfig:
    return evoframe.load_config("bending")


@pytest.fixture(scope="module")
def crawl() -> RunConfig:
    return evoframe.load_config("locomotion")


def canvas_of(config: RunConfig) -> Any:
    encoder: Any = config.populations[MORPHOLOGY].encoder.component
    return encoder.canvas


def score(simulator: Any, config: RunConfig, design: Design) -> float:
    objective = config.objective.component
    [outcome] = simulator.simulate([design], objective.record)
    assert outcome.diverged_at is None
    return objective.score(outcome)


def variants(config: RunConfig, design: Design, *names: str) -> list[float]:
    """Return the scores of the variants with these names."""
    simulator: Any = config.simulator.component
    found = {each.name: each for each in simulator.variants(design, config.objective.component.record)}
    return [score(found[name].simulator, config, found[name].design) for name in names]


@pytest.mark.parametrize("inside", [PASSIVE, 0])
def test_the_bar_is_driven_below_its_first_bending_mode(bend: RunConfig, inside: int) -> None:
    vox: Any = bend.simulator.component
    mode = first_mode(vox, bar(canvas_of(bend), inside))
    assert 0.4 < vox.frequency / mode < 0.5


def test_a_bimorph_bends_by_more_than_a_voxel_and_not_by_collision(bend: RunConfig) -> None:
    design = bimorph(canvas_of(bend))
    displacement, _ = bending(bend.simulator.component, bend.objective.component, design)
    assert displacement == pytest.approx(1.475, abs=0.001)  # voxel edges; docs/results.md
    idle, apart, halved = variants(
        bend, design, "contraction off", "self collision off", "half the time step"
    )
    edge = bend.simulator.component.voxel_size  # type: ignore[attr-defined]  # of vox
    assert idle < 1e-6 * edge
    assert apart == pytest.approx(displacement * edge, rel=1e-3)
    assert halved == pytest.approx(displacement * edge, rel=1e-3)


def wave(canvas: tuple[int, int, int]) -> NDArray[np.float64]:
    """Return phase offsets, radians, of one wave along x."""
    turns = np.arange(canvas[0]) / canvas[0]
    offsets: NDArray[np.float64] = np.zeros(canvas) + 2 * np.pi * turns[:, None, None]
    return offsets


def test_a_reversed_wave_crawls_in_the_opposite_direction(crawl: RunConfig) -> None:
    canvas = canvas_of(crawl)
    body = np.full(canvas, CONTRACTILE, np.uint8)
    forth = Design({MORPHOLOGY: body, CONTROLLER: wave(canvas)})
    back = Design({MORPHOLOGY: body, CONTROLLER: wave(canvas)[::-1]})
    simulator: Any = crawl.simulator.component
    along = attrs.evolve(crawl.objective.component, along="x")  # type: ignore[misc]  # of travel
    [there], [here] = (simulator.simulate([design], along.record) for design in (forth, back))
    edge = simulator.voxel_size
    assert along.score(there) < -3 * edge
    assert along.score(here) > 3 * edge


def test_a_body_that_does_not_contract_stays_where_it_is(crawl: RunConfig) -> None:
    canvas = canvas_of(crawl)
    design = Design({MORPHOLOGY: np.full(canvas, CONTRACTILE, np.uint8), CONTROLLER: wave(canvas)})
    [idle] = variants(crawl, design, "contraction off")
    assert idle < 1e-9


@pytest.mark.parametrize("preset", ["bending", "locomotion"])
def test_a_preset_runs(preset: str, tmp_path: Any) -> None:
    small: dict[str, Any] = {f"populations.{role}.size": 3 for role in (MORPHOLOGY, CONTROLLER)}
    settings = {**small, "run.generations": 1, "simulator.duration": 0.55, "collaboration.n": 1}
    finished = evoframe.run(preset, out=tmp_path / "run", aggregator="am", **settings)
    assert len(finished.turns()) == 4
    assert finished.champion().score >= 0
    assert [row["score"] for row in finished.pairs() if row["score"] is not None]
