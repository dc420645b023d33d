"""What a measurement says, in words: also what it cannot say."""

from __future__ import annotations

from collections.abc import Iterator

from evoframe.analysis.robustness.findings import Findings
from evoframe.analysis.statistics.blocks import BlockComparison, BlockPair
from evoframe.analysis.statistics.groups import Comparison
from evoframe.analysis.statistics.pairs import oriented
from evoframe.analysis.statistics.words import conclusion, corrected, counted, in_words, listed
from evoframe.robustness.measurement import Robustness

__all__ = ["conclusions"]

_ALPHA = 0.05
_MANY = 300  # controllers, with which one body that beats another with 58 % of them is found
_MOST = 10  # pairs, or names, that a reader follows
_FEWEST = 6  # controllers; whoever wins with all of 5 may do so by chance in 1 of 16 cases
_CONTROLLERS = ("controller", "controllers")


def conclusions(found: Findings) -> str:
    """Return paragraphs on what can and what cannot be concluded."""
    measured = found.measured
    parts = [_measured(measured), *_twins(measured), *_divergences(found)]
    if found.apart is not None and found.within is not None:
        parts += [_apart(found.apart), _within(found.within), _size(found, found.within), _by_body(found)]
    elif found.common:
        parts.append("There is nothing that it could be compared with, so there are no tests.")
    return "\n\n".join(parts) + "\n"


def _measured(measured: Robustness) -> str:
    setting = measured.setting
    bodies, controllers = counted(len(setting.bodies), "body", "bodies"), setting.controllers
    drawn = counted(controllers, *_CONTROLLERS)
    words = f"{bodies} with {drawn}, drawn at random from seed {setting.seed} and the same for every body."
    if len(setting.bodies) > len(setting.groups) > 1:
        words += " With each controller, a group is worth the median of its bodies' scores."
    return words


def _twins(measured: Robustness) -> Iterator[str]:
    """Say which bodies are one body, found more than once."""
    alike: dict[str, list[str]] = {}
    for body in measured.setting.bodies:
        alike.setdefault(body.digest, []).append(body.label)
    twins = [labels for labels in alike.values() if len(labels) > 1]
    if twins and sum(map(len, twins)) <= _MOST:
        yield " ".join(f"{listed(labels)} are the same body." for labels in twins)
    elif twins:
        bodies = len(measured.setting.bodies)
        yield f"Only {len(alike)} of the {bodies} bodies are different; bodies.csv has their digests."


def _divergences(found: Findings) -> Iterator[str]:
    measured, setting = found.measured, found.measured.setting
    if not measured.diverged:
        return
    groups = {name: measured.lost(columns) for name, columns in setting.groups.items()}
    where = listed([f"{lost} of {name}" for name, lost in groups.items() if lost])
    lost = counted(len(measured.diverged), "simulation", "simulations")
    yield f"{lost} diverged, and there is no score for that: {where}. {_left_out(found)}"


def _left_out(found: Findings) -> str:
    if not found.common:
        return "There is no controller with which no body diverged, so there are no tests."
    out = counted(found.measured.setting.controllers - found.common, *_CONTROLLERS)
    return f"All tests leave out {out}, with which a body diverged, for all bodies; {found.common} remain."


def _apart(comparison: Comparison) -> str:
    words = conclusion(comparison, "the score", _CONTROLLERS)
    heading = f"Each controller for itself, the test of the paper: {comparison.ranking}"
    return f"{heading}\n{' '.join([*_shapes(comparison), words])}"


def _shapes(comparison: Comparison) -> Iterator[str]:
    crooked = [
        group.name for group in comparison.groups if group.shapiro_p is not None and group.shapiro_p < _ALPHA
    ]
    if len(crooked) > _MOST:
        yield f"The scores of {len(crooked)} groups are not normally distributed (Shapiro-Wilk, p < 0.05)."
    elif crooked:
        yield f"The scores of {listed(crooked)} are not normally distributed (Shapiro-Wilk, p < 0.05)."


def _within(blocks: BlockComparison) -> str:
    heading = f"Within controllers, as all bodies have the same: {blocks.ranking(_ALPHA)}"
    return f"{heading}\n{' '.join([_overall(blocks), _pairs(blocks)])}"


def _overall(blocks: BlockComparison) -> str:
    differs = "differs" if blocks.p < _ALPHA else "is not found to differ"
    p = in_words(blocks.p)
    if blocks.chi_squared is None or blocks.kendall_w is None:
        return f"The score {differs} (Wilcoxon's test, p {p})."
    test = f"Friedman, chi-squared = {blocks.chi_squared:.2f}, p {p}"
    return f"The score {differs} as a whole ({test}, Kendall's W {blocks.kendall_w:.3f})."


def _pairs(blocks: BlockComparison) -> str:
    different = [pair for pair in blocks.pairs if pair.p < _ALPHA]
    test = f"Wilcoxon's test, {corrected(blocks.correction)}"
    if blocks.blocks < _FEWEST:
        least = 2.0 ** (1 - blocks.blocks)
        return f"No pair can be told apart: with {blocks.blocks} controllers p is at least {least:.3g}."
    if not different:
        return f"No pair can be told apart by {test}."
    if len(different) > _MOST:
        return f"{len(different)} of {len(blocks.pairs)} pairs differ by {test}; the tables name them."
    doubt = " As all together are not found to differ, this is weak evidence." if blocks.p >= _ALPHA else ""
    return f"{listed([_greater(oriented(pair)) for pair in different])}, by {test}; ties count half.{doubt}"


def _greater(pair: BlockPair) -> str:
    often = f"the greater with {pair.wins:.1%} of the controllers"
    return f"{pair.first} is above {pair.second} ({often}, p {in_words(pair.p)})"


def _size(found: Findings, blocks: BlockComparison) -> str:
    """Say that many controllers find differences that matter to nobody."""
    text = (
        "A p says whether there is a difference, not whether it matters: more controllers make any "
        "difference significant"
    )
    enough = f", and {blocks.blocks} are enough for small ones." if blocks.blocks >= _MANY else "."
    words = [f"{text}{enough}", *_smallest(found, blocks), "Judge by medians and by how often one wins."]
    return " ".join(words)


def _smallest(found: Findings, blocks: BlockComparison) -> Iterator[str]:
    """Say how small the smallest difference between two bodies is that was found."""
    if len(found.measured.setting.bodies) > len(found.measured.setting.groups):
        return  # the medians of what groups are worth stand in no table
    groups = () if found.apart is None else found.apart.groups
    medians = {group.name: group.median for group in groups}
    gaps = [
        (abs(medians[pair.first] - medians[pair.second]), pair) for pair in blocks.pairs if pair.p < _ALPHA
    ]
    if gaps:
        gap, pair = min(gaps, key=lambda found: found[0])
        unit = found.measured.setting.unit
        shown = f"{1000 * gap:.3g} mm" if unit == "m" else f"{gap:.3g} {unit}".rstrip()
        yield f"The smallest found here: the medians of {pair.first} and {pair.second} are {shown} apart."


def _by_body(found: Findings) -> str:
    alone = [name for name, columns in found.measured.setting.groups.items() if len(columns) == 1]
    if found.by_body is None:
        return (
            "Each group is one body, so all this is about these bodies. Nothing is said of the methods that "
            "made them, however many controllers are drawn: another run of a method gives another body. For "
            "that, measure the champions of many runs."
        )
    words = conclusion(found.by_body, "the median of a body", ("body", "bodies"))
    text = f"One value for each body, its median: {found.by_body.ranking}\n{words}"
    if alone:
        few = listed(alone) if len(alone) <= _MOST else f"{len(alone)} groups"
        text += f" {few} {'is one body' if len(alone) == 1 else 'are one body each'}: no sample of a method."
    return f"{text} Only this comparison is about what made the bodies; those above are about these bodies."
