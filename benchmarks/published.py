"""Comparison of the study ``paper`` with each published ranking, by score and by fitness.

The rankings (docs/experiment.md, "The experiments") are tested with the paper's test, Dunn's without
correction, and with Holm's correction. Prints tables in Markdown.

    python -m benchmarks.published docs/results/paper/rows.csv
"""

from __future__ import annotations

import argparse
import statistics
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from evoframe.analysis.data.studies import YARDSTICKS, Yardstick
from evoframe.analysis.statistics.groups import Comparison, compare
from evoframe.study.rows import Row, read_rows

AVERAGES = ("AM", "WM", "GM", "HM")
WITHIN = {
    "2": ("WM > HM", "HM > AM", "AM = GM"),
    "3": ("WM = AM", "AM > GM", "GM > HM"),
    "5": ("AM > WM", "WM = GM", "GM = HM"),
    "7": ("WM > AM", "AM = GM", "GM = HM"),
    "10": ("WM > HM", "HM > AM", "AM > GM"),
}
"""Number of collaborators -> the published ranking, as comparisons of neighbors."""
OVERALL = ("WM(2) > WM(3)", "WM(3) = WM(10)", "WM(10) > AM(5)", "AM(5) = WM(7)")

BEYOND = 0.006  # m; greater scores are above the plateau
ALPHA = 0.05

Groups = Mapping[str, Sequence[Row]]


def groups_of(rows: Sequence[Row]) -> dict[str, list[Row]]:
    """Return the runs of each cell by its name, such as ``WM(2)``."""
    found: dict[str, list[Row]] = {}
    for row in rows:
        name = f"{row.settings['aggregator'].upper()}({row.settings['collaboration.n']})"
        found.setdefault(name, []).append(row)
    return found


def values(groups: Groups, yardstick: Yardstick) -> dict[str, list[float]]:
    """Return the final values of each group."""
    return {name: [getattr(row, yardstick) for row in rows] for name, rows in groups.items()}


def verdict(relation: str, p: float, direction: int) -> str:
    """Return whether a test agrees with a published relation, ``>`` or ``=``."""
    if relation == "=":
        return "agrees" if p >= ALPHA else "**disagrees**"
    if p >= ALPHA:
        return "cannot tell"
    return "agrees" if direction > 0 else "**disagrees**"


def tested(comparison: Comparison, first: str, relation: str, second: str) -> str:
    """Return the verdict on a published relation, with the test's p and A12."""
    pair = comparison.pair(first, second)
    return f"{verdict(relation, pair.p, pair.direction)} (p {pair.p:.2g}, A12 {pair.a12:.2f})"


def lines(groups: Groups, published: Sequence[str], label: str) -> Iterator[str]:
    """Yield a line of a table for each published relation of these groups."""
    comparisons = [
        compare(values(groups, yardstick), correction)
        for yardstick in YARDSTICKS
        for correction in ("none", "holm")
    ]
    for text in published:
        first, relation, second = text.split()
        cells = [tested(comparison, first, relation, second) for comparison in comparisons]
        yield f"| {label} | {text} | {' | '.join(cells)} |"


def rankings(rows: Sequence[Row]) -> Iterator[str]:
    """Yield the table of all published rankings."""
    every = groups_of(rows)
    judged = ("best pair, test of the paper", "after Holm", "last fitness, test of the paper", "after Holm")
    yield f"| n | published | {' | '.join(judged)} |"
    yield "|---|---|---|---|---|---|"
    for n, published in WITHIN.items():
        yield from lines({name: every[f"{name}({n})"] for name in AVERAGES}, published, n)
    named = dict.fromkeys(name for text in OVERALL for name in text.split()[::2])
    yield from lines({name: every[name] for name in named}, OVERALL, "all")


def tests(rows: Sequence[Row]) -> Iterator[str]:
    """Yield the table of tests: averages for each number of collaborators, and numbers for all averages."""
    every = groups_of(rows)
    compared: dict[str, Groups] = {n: {name: every[f"{name}({n})"] for name in AVERAGES} for n in WITHIN}
    compared["2 to 10"] = {f"n = {n}": [row for part in compared[n].values() for row in part] for n in WITHIN}
    yield "| n | yardstick | Kruskal-Wallis H | p | epsilon squared | ranking after Holm |"
    yield "|---|---|---|---|---|---|"
    for n, groups in compared.items():
        for yardstick in YARDSTICKS:
            found = compare(values(groups, yardstick))
            figures = f"{found.h:.2f} | {found.p:.2g} | {found.epsilon_squared:.3f} | {found.ranking}"
            yield f"| {n} | {yardstick} | {figures} |"


def cells(rows: Sequence[Row]) -> Iterator[str]:
    """Yield the table of each cell's values, in millimeters."""
    shown = ("best pair: median", "quartiles", "mean", "above 6 mm", "last fitness: median", "mean")
    yield f"| n | average | runs | {' | '.join(shown)} |"
    yield "|---|---|---|---|---|---|---|---|---|"
    every = groups_of(rows)
    for n in WITHIN:
        for name in AVERAGES:
            scores, fitness = (
                [1000 * value for value in values({"": every[f"{name}({n})"]}, yardstick)[""]]
                for yardstick in YARDSTICKS
            )
            low, middle, high = statistics.quantiles(scores, n=4, method="inclusive")
            beyond = sum(score > 1000 * BEYOND for score in scores)
            best = f"{middle:.3f} | {low:.3f}, {high:.3f} | {statistics.fmean(scores):.3f} | {beyond}"
            last = f"{statistics.median(fitness):.3f} | {statistics.fmean(fitness):.3f}"
            yield f"| {n} | {name} | {len(scores)} | {best} | {last} |"


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("rows", type=Path, help="rows.csv of the study")
    rows = read_rows(parser.parse_args().rows)
    for table in (cells, tests, rankings):
        print("\n".join(table(rows)), end="\n\n")  # noqa: T201 - a command


if __name__ == "__main__":
    main()
