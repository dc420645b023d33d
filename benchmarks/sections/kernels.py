"""Speed of each kernel that this processor supports."""

from __future__ import annotations

import attrs
import numpy as np

from benchmarks.report import Row, Section, Table
from benchmarks.subjects import bonds_of, model, solid, solving
from benchmarks.timing import Effort, interleaved
from evoframe_libvox import KERNELS, Model

__all__ = ["kernels"]

_BATCH = 8  # so that the shared set-up of the body is negligible


@attrs.frozen
class _Way:
    """A way to simulate the solid canvas."""

    name: str
    passive: bool
    whole_body: bool
    self_collision: bool

    def model(self, kernel: str) -> Model:
        return model(
            kernel=kernel,
            whole_body=self.whole_body,
            passive=self.passive,
            self_collision=self.self_collision,
        )


_WAYS = (
    _Way("at rest", passive=True, whole_body=True, self_collision=False),
    _Way("contracting", passive=False, whole_body=True, self_collision=False),
    _Way("as in paper", passive=False, whole_body=False, self_collision=True),
)


def kernels(effort: Effort) -> Section:
    """Time the solid canvas with every kernel."""
    bonds = bonds_of(solid())
    actions = {
        (way, kernel): solving(way.model(kernel), [solid()] * _BATCH) for way in _WAYS for kernel in KERNELS
    }
    taken = interleaved(actions, effort)
    steps = int(model().time_steps(np.stack([solid().roles["morphology"]]))[1][0])
    bond_steps = _BATCH * bonds * steps
    rows: list[Row] = [
        (
            kernel,
            *(
                figure
                for way in _WAYS
                for figure in (
                    1e9 * taken[way, kernel] / bond_steps,
                    taken[way, "scalar"] / taken[way, kernel],
                )
            ),
        )
        for kernel in KERNELS
    ]
    columns = tuple(column for way in _WAYS for column in (f"{way.name}, ns", f"{way.name}, times scalar"))
    table = Table(
        f"ns per bond-step on the solid canvas: {bonds:,} bonds, {steps} steps",
        ("kernel", *columns),
        rows,
        f"Whole calls for {_BATCH} controllers of the body: set-up, bonds, motion and samples, divided by "
        "bonds times steps. The first two ways compute the whole body to the end, without self collision; at "
        "rest no voxel contracts, so all bonds are in the small frame. CPU time. Goals: avx512 4.5, avx2 2.7 "
        "times as fast as scalar.",
    )
    return Section("time per bond-step of each kernel", (table,))
