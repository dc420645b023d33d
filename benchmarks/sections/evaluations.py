"""CPU time of an evaluation, and the share of contacts in it."""

from __future__ import annotations

import statistics

import attrs

from benchmarks.report import Row, Section, Table
from benchmarks.subjects import (
    bonds_of,
    evaluating,
    model,
    published,
    random_designs,
    solid,
    solving,
    vox,
)
from benchmarks.timing import Effort, interleaved
from evoframe import Design

__all__ = ["evaluations"]

_BATCH = 4  # controllers of one body


def evaluations(effort: Effort) -> Section:
    """Time the published bodies, random ones, contacts, and whole bodies."""
    return Section(
        "CPU time of an evaluation in the setting of paper",
        (_published(effort), _random(effort), _contacts(effort), _whole(effort)),
    )


def _published(effort: Effort) -> Table:
    scalar, fast = model(kernel="scalar"), model()
    actions = {
        (name, way): action
        for name, design in published().items()
        for way, action in {
            "alone": evaluating(vox(), [design]),
            "batch": evaluating(vox(), [design] * _BATCH),
            "scalar": solving(scalar, [design] * _BATCH),
            "fast": solving(fast, [design] * _BATCH),
        }.items()
    }
    taken = interleaved(actions, effort)
    rows: list[Row] = [
        (
            name,
            _voxels(design),
            bonds_of(design),
            1e6 * taken[name, "alone"],
            1e6 * taken[name, "batch"] / _BATCH,
            1e6 * taken[name, "scalar"] / _BATCH,
            taken[name, "scalar"] / taken[name, "fast"],
        )
        for name, design in published().items()
    ]
    return Table(
        "Published bodies, with self collision",
        ("body", "voxels", "bonds", "alone, us", f"in a batch of {_BATCH}, us", "scalar, us", "times scalar"),
        rows,
        f"Simulated with the simulator vox (kernel {fast.kernel}) and scored. The {_BATCH} controllers of a "
        "batch share the set-up of their body; a body that is simulated again, as here in each round, may "
        "still be kept by the solver. The last two columns are the time of the solver with the scalar "
        "kernel, and its ratio to that with the fastest kernel.",
    )


def _random(effort: Effort) -> Table:
    bodies = random_designs(effort.designs, _BATCH)
    alone = {(number, 1): evaluating(vox(), designs[:1]) for number, designs in enumerate(bodies)}
    batches = {(number, _BATCH): evaluating(vox(), designs) for number, designs in enumerate(bodies)}
    taken = interleaved(alone | batches, effort)
    rows: list[Row] = [
        (how, min(times), statistics.median(times), max(times))
        for how, size in (("alone", 1), (f"in a batch of {_BATCH}", _BATCH))
        for times in [[1e6 * taken[number, size] / size for number in range(len(bodies))]]
    ]
    return Table(
        f"Random bodies: {len(bodies)}, with random controllers",
        ("evaluation", "least, us", "median, us", "greatest, us"),
        rows,
        "Networks of the evolver random with up to 10 mutations, from a fixed seed; with self collision.",
    )


def _contacts(effort: Effort) -> Table:
    touching, passing = vox(), attrs.evolve(vox(), self_collision=False)
    bodies = {name: design for name, design in published().items() if name.startswith("HyperNEAT")}
    actions = {
        (name, simulator.self_collision, size): evaluating(simulator, [design] * size)
        for name, design in bodies.items()
        for size in (1, _BATCH)
        for simulator in (touching, passing)
    }
    taken = interleaved(actions, effort)
    rows: list[Row] = [
        (
            name,
            *(
                figure
                for size in (1, _BATCH)
                for figure in (
                    1e3 * taken[name, True, size] / size,
                    1e3 * taken[name, False, size] / size,
                    1.0 - taken[name, False, size] / taken[name, True, size],
                )
            ),
        )
        for name in bodies
    ]
    batch = f"batch of {_BATCH}"
    return Table(
        "The HyperNEAT body with and without self collision",
        (
            "body",
            *("alone, ms", "without, ms", "share of contacts"),
            *(f"{batch}, ms", f"{batch} without, ms", f"{batch}: share of contacts"),
        ),
        rows,
        "The share is the time saved without self collision: the list of contacts, their forces, and the "
        "voxels that must be computed because of them.",
    )


def _whole(effort: Effort) -> Table:
    bodies = {"solid canvas": solid(), **published()}
    models = {False: model(), True: model(whole_body=True)}
    actions = {
        (name, whole): solving(models[whole], [design] * _BATCH)
        for name, design in bodies.items()
        for whole in models
    }
    taken = interleaved(actions, effort)
    rows: list[Row] = [
        (
            name,
            1e6 * taken[name, False] / _BATCH,
            1e6 * taken[name, True] / _BATCH,
            taken[name, True] / taken[name, False],
        )
        for name in bodies
    ]
    return Table(
        "Computing only what can affect a sample, and whole bodies",
        ("body", "what can, us", "whole, us", "whole / what can"),
        rows,
        f"Calls of the solver for batches of {_BATCH}; the results are the same to the last bit.",
    )


def _voxels(design: Design) -> int:
    return int((design.roles["morphology"] != 0).sum())
