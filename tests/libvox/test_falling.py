"""The motion of a body ends when a voxel of a given material touches the floor."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from evoframe_libvox import Material, Model

ModelMaker = Callable[..., Model]
MaterialMaker = Callable[..., Material]
Follow = Callable[..., dict[str, NDArray[np.float64]]]
TOWER = np.array([0, 1, 2]).reshape(1, 1, 3)  # a voxel of each material, one above the other, in the air


@pytest.fixture
def fall(small_model: ModelMaker, material: MaterialMaker, follow: Follow) -> Callable[..., Any]:
    def fall(falling_code: int, body: Any = TOWER, **options: Any) -> NDArray[np.float64]:
        model = small_model(
            np.shape(body),
            palette={1: material(), 2: material()},
            gravity=-9.81,
            falling_code=falling_code,
            duration=0.5,
            **options,
        )
        return follow(model, body, tracks=["body"])["body"][:, 2]

    return fall


@pytest.mark.parametrize("floor", [True, False])
def test_samples_repeat_the_state_of_the_contact(fall: Callable[..., Any], floor: bool) -> None:
    z, free = fall(1, floor=floor), fall(0, floor=floor)
    last = int(np.flatnonzero(z != free)[0]) - 1
    assert 10 < last < len(z) - 10
    assert (z[last:] == z[last]).all()
    assert z[last] < z[last - 1]
    assert z[last] == pytest.approx(0.05, abs=0.01)  # two voxels stand on the floor


def test_only_the_material_counts(fall: Callable[..., Any]) -> None:
    assert (fall(2, floor=True) == fall(0, floor=True)).all()
    assert (fall(77, floor=True) == fall(0, floor=True)).all()


def test_a_voxel_on_the_floor_has_not_fallen(fall: Callable[..., Any]) -> None:
    """Touching is not enough: it must be below the plane."""
    standing = fall(1, body=np.array([1, 2]).reshape(1, 1, 2), floor=True)
    assert standing[1] != standing[0]
