"""The simulator ``vox``: the Python face of the voxel solver libvox."""
