"""What the tests of the solver share: the paper's setting, small models, a way to say what was measured."""

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from evoframe_libvox import Material, Model, Settings

Arrays = dict[str, NDArray[Any]]


def small_settings(**changes: Any) -> Settings:
    """Settings for a few dozen steps of small bodies with the paper's materials."""
    options: dict[str, Any] = {
        "voxel_size": 0.05,
        "duration": 0.1,
        "temperature_amplitude": 14.4714242553,
        "period": 0.25,
    }
    return Settings(**(options | changes))


def material(**changes: float) -> Material:
    """Return the paper's passive material, or another."""
    options = {"youngs_modulus": 5e6, "poisson_ratio": 0.35, "density": 1e6, "expansion": 0.0}
    return Material(**(options | changes))


PALETTE = {1: material(), 3: material(expansion=0.01)}


def small_model(
    canvas: tuple[int, int, int],
    palette: dict[int, Material] | None = None,
    clamped: NDArray[np.bool_] | None = None,
    **changes: Any,
) -> Model:
    """Return a model that clamps nothing unless told."""
    held = np.zeros(canvas, bool) if clamped is None else clamped
    return Model(canvas, palette or PALETTE, small_settings(**changes), held)


@pytest.fixture(name="small_settings")
def _small_settings() -> Callable[..., Settings]:
    return small_settings


@pytest.fixture(name="material")
def _material() -> Callable[..., Material]:
    return material


@pytest.fixture(name="palette")
def _palette() -> dict[int, Material]:
    return dict(PALETTE)


@pytest.fixture(name="small_model")
def _small_model() -> Callable[..., Model]:
    return small_model


@pytest.fixture(scope="session")
def data() -> Path:
    return Path(__file__).parent.parent / "data"


@pytest.fixture(scope="session")
def paper(data: Path) -> Arrays:
    """The traces of the paper's setting: 36 bodies with controllers."""
    with np.load(data / "paper_preset.npz") as arrays:
        return dict(arrays)


@pytest.fixture(scope="session")
def paper_model() -> Callable[..., Model]:
    """Make the paper's model: slab x = 0 clamped, 22 steps."""

    def make(expansion: float = 0.01, **changes: Any) -> Model:
        canvas = (20, 8, 8)
        held = np.zeros(canvas, bool)
        held[0] = True
        settings = small_settings(duration=0.07, temperature_amplitude=39.4714242553 - 25.0, **changes)
        return Model(canvas, {1: material(), 3: material(expansion=expansion)}, settings, held)

    return make


@pytest.fixture
def say(capsys: pytest.CaptureFixture[str]) -> Callable[[str], None]:
    """Print what was measured, whatever pytest captures."""

    def write(text: str) -> None:
        with capsys.disabled():
            sys.stdout.write(f"\n    {text}\n")

    return write
