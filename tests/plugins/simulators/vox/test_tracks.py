"""Tracks that a simulation can record."""

from __future__ import annotations

import math

import numpy as np
import pytest
from bars import bar
from hypothesis import given, strategies as st

from evoframe import ConfigurationError, InputError, Record
from evoframe_simulators import Vox
from evoframe_simulators.vox.limits import MOST_RECORD_BYTES
from evoframe_simulators.vox.tracks import FURTHER, POINTS, check_size, shape_of


class TestTracks:
    record = Record(("tip", "voxels", "energy", "strain", "momentum"), initial=True)

    def test_further_tracks_have_their_documented_shapes(self) -> None:
        vox = Vox()
        vox.check(self.record)
        empty = bar(0, 0)
        for outcome in vox.simulate([bar(1, 3, 0), empty], self.record):
            samples = len(outcome.steps)
            canvas = (3, 1, 1) if samples else (2, 1, 1)
            shapes = {name: track.shape for name, track in outcome.tracks.items()}
            assert shapes == {
                "tip": (samples, 3),
                "voxels": (samples, *canvas, 3),
                "energy": (samples, 2),
                "strain": (samples, 2),
                "momentum": (samples, 6),
            }

    def test_the_last_voxel_is_the_tip(self) -> None:
        [outcome] = Vox().simulate([bar(1, 3, 3, 0)], self.record)
        assert (outcome.tracks["voxels"][:, 2, 0, 0] == outcome.tracks["tip"]).all()
        assert np.isnan(outcome.tracks["voxels"][:, 3]).all()

    def test_the_error_for_an_unknown_track_names_the_available_ones(self) -> None:
        expected = "tip, face, body; .* voxels, energy, strain, momentum$"
        with pytest.raises(ConfigurationError, match=f"'voxel'; .* {expected}"):
            Vox().check(Record(("tip", "voxel")))

    def test_a_record_that_exceeds_the_memory_is_rejected(self) -> None:
        vox = Vox(duration=20_000.0, step_limit=10**8)
        with pytest.raises(InputError, match=r" voxels .* GiB .* 4 GiB;"):
            vox.simulate([bar(*[1] * 200)], Record(("voxels",)))

    @pytest.mark.parametrize("record", [Record(("tip",)), Record(("tip",), every=0.01, samples=(0, 3))])
    def test_substeps_leave_the_instants_where_they_are(self, record: Record) -> None:
        [coarse], [fine] = (Vox(substeps=k).simulate([bar(1, 3, 3)], record) for k in (1, 5))
        assert (fine.steps == 5 * coarse.steps).all()
        assert fine.times == pytest.approx(coarse.times, rel=1e-14)
        assert 0 < np.abs(fine.tracks["tip"] - coarse.tracks["tip"]).max() < 0.02 * Vox().voxel_size


@given(
    canvas=st.tuples(*[st.integers(1, 300)] * 3),
    tracks=st.sets(st.sampled_from((*POINTS, *FURTHER)), min_size=1),
)
def test_the_largest_record_is_accepted_and_one_more_sample_is_rejected(
    canvas: tuple[int, int, int], tracks: set[str]
) -> None:
    sample = sum(8 * math.prod(shape_of(track, canvas)) for track in tracks)
    most = MOST_RECORD_BYTES // sample
    check_size(tracks, canvas, most)
    with pytest.raises(InputError, match=f"^{most + 1} samples .* 4 GiB;"):
        check_size(tracks, canvas, most + 1)
