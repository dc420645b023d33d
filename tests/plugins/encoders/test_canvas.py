import numpy as np

from evoframe_encoders.canvas import voxel_points


def test_points_are_the_indices_of_voxels() -> None:
    points = voxel_points((20, 8, 8), normalized=False)
    assert points.shape == (20, 8, 8, 3)
    assert points.dtype == np.float64
    for index in np.ndindex(20, 8, 8):
        assert tuple(points[index]) == index


def test_normalized_axes_run_from_minus_1_to_1() -> None:
    points = voxel_points((5, 2, 1), normalized=True)
    assert points[:, 0, 0, 0].tolist() == [-1.0, -0.5, 0.0, 0.5, 1.0]
    assert points[0, :, 0, 1].tolist() == [-1.0, 1.0]
    assert points[0, 0, :, 2].tolist() == [0.0]
