"""Fixtures for the tests of the solver: the paper's setting, small models, and output of measurements."""

import sys
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, get_args

import numpy as np
import pytest
from numpy.typing import ArrayLike, NDArray

from evoframe_libvox import FIX_ALL, Material, Model, Settings, Track

Arrays = dict[str, NDArray[Any]]


def small_settings(**changes: Any) -> Settings:
    """Return settings for a few dozen steps of small bodies with the paper's materials."""
    options: dict[str, Any] = {
        "voxel_size": 0.05,
        "duration": 0.1,
        "temperature_amplitude": 14.4714242553,
        "period": 0.25,
    }
    return Settings(**(options | changes))


def material(**changes: float) -> Material:
    """Return the paper's passive material with changes."""
    options = {"youngs_modulus": 5e6, "poisson_ratio": 0.35, "density": 1e6, "expansion": 0.0}
    return Material(**(options | changes))


PALETTE = {1: material(), 3: material(expansion=0.01)}


def small_model(
    canvas: tuple[int, int, int],
    palette: dict[int, Material] | None = None,
    fixed: ArrayLike | None = None,
    *,
    kernel: str | None = None,
    whole_body: bool = False,
    **changes: Any,
) -> Model:
    """Return a model, by default without fixed cells."""
    held = np.zeros(canvas, np.uint8) if fixed is None else np.asarray(fixed, np.uint8).reshape(canvas)
    settings = small_settings(**changes)
    return Model(canvas, palette or PALETTE, settings, held, kernel=kernel, whole_body=whole_body)


def follow(
    model: Model,
    body: ArrayLike = 1,
    phase: ArrayLike = 0.0,
    steps: Iterable[int] | None = None,
    tracks: Iterable[Track] = get_args(Track),
) -> Arrays:
    """Return the tracks of one body, which must not diverge, after every step or after the given steps.

    A single material or phase applies to all cells; arrays have the order ``[X, Y, Z]``.
    """
    cells, phases = (
        np.broadcast_to(a, model.canvas) if np.ndim(a) == 0 else np.reshape(a, model.canvas)
        for a in (np.asarray(body, np.uint8), np.asarray(phase, np.float64))
    )
    wanted = range(int(model.time_steps(cells[None])[1][0]) + 1) if steps is None else steps
    result = model.simulate(cells[None], phases[None], list(wanted), tracks)
    assert result.diverged_step.tolist() == [0]
    return {name: track[0] for name, track in result.tracks.items()}


@pytest.fixture(name="small_settings", scope="session")
def _small_settings() -> Callable[..., Settings]:
    return small_settings


@pytest.fixture(name="material", scope="session")
def _material() -> Callable[..., Material]:
    return material


@pytest.fixture(name="palette")
def _palette() -> dict[int, Material]:
    return dict(PALETTE)


@pytest.fixture(name="small_model", scope="session")
def _small_model() -> Callable[..., Model]:
    return small_model


@pytest.fixture(name="follow", scope="session")
def _follow() -> Callable[..., Arrays]:
    return follow


@pytest.fixture(scope="session")
def data() -> Path:
    return Path(__file__).parent.parent / "data"


@pytest.fixture(scope="session")
def paper(data: Path) -> Arrays:
    """Traces of the paper's setting: 36 bodies with controllers."""
    with np.load(data / "paper_preset.npz") as arrays:
        return dict(arrays)


@pytest.fixture(scope="session")
def paper_model() -> Callable[..., Model]:
    """Create models of the paper: slab x = 0 clamped, 22 steps."""

    def make(
        expansion: float = 0.01, *, kernel: str | None = None, whole_body: bool = False, **changes: Any
    ) -> Model:
        canvas = (20, 8, 8)
        held = np.zeros(canvas, np.uint8)
        held[0] = FIX_ALL
        settings = small_settings(duration=0.07, temperature_amplitude=39.4714242553 - 25.0, **changes)
        palette = {1: material(), 3: material(expansion=expansion)}
        return Model(canvas, palette, settings, held, kernel=kernel, whole_body=whole_body)

    return make


@pytest.fixture
def report(capsys: pytest.CaptureFixture[str]) -> Callable[[str], None]:
    """Print a measurement in spite of pytest's capturing."""

    def write(text: str) -> None:
        with capsys.disabled():
            sys.stdout.write(f"\n    {text}\n")

    return write
