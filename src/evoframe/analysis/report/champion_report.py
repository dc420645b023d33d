"""The champion in a report: figures of its body and its networks, and sections of the page."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import attrs

from evoframe.analysis.data.champions import ChampionData
from evoframe.analysis.data.tables import verification_table
from evoframe.analysis.data.units import with_unit
from evoframe.analysis.figures.bodies import body
from evoframe.analysis.figures.networks import TooLargeError, network
from evoframe.analysis.output.writing import Rendered, rendered, write_table
from evoframe.analysis.page.page import Block, Motion, Picture, Section, Table, Words

__all__ = ["DrawnChampion", "champion_sections", "drawn", "write_champion"]


@attrs.frozen(eq=False)
class DrawnChampion:
    """A champion with its figures.

    Attributes:
        data: What is known of it.
        body: What it looks like; ``None`` if its simulator does not say.
        networks: Population -> the network of its genome.
        undrawn: Population -> why its network is not drawn.
    """

    data: ChampionData
    body: Rendered | None
    networks: Mapping[str, Rendered]
    undrawn: Mapping[str, str]


def drawn(data: ChampionData) -> DrawnChampion:
    """Draw the figures of a champion."""
    title = with_unit(data.score, data.unit)
    networks, undrawn = {}, {}
    for each in data.networks:
        try:
            figure = network(each.graph, each.inputs, each.outputs, each.population)
        except TooLargeError as error:
            undrawn[each.population] = str(error)
        else:
            networks[each.population] = rendered(figure, f"champion-network-{each.population}")
    shape = rendered(body(data.geometry, title), "champion-body") if data.geometry else None
    return DrawnChampion(data, shape, networks, undrawn)


def write_champion(champion: DrawnChampion, directory: Path) -> list[Path]:
    """Write the figures of a champion, and the table of its verification if there is one.

    Raises:
        RunError: They cannot be written.
    """
    figures = [*([champion.body] if champion.body else []), *champion.networks.values()]
    written = [path for figure in figures for path in figure.write(directory)]
    if champion.data.verification is not None:
        written += write_table(verification_table(champion.data.verification), directory / "verification")
    return written


def champion_sections(champion: DrawnChampion, whose: str) -> list[Section]:
    """Return what a page shows of a champion.

    Args:
        champion: What is shown.
        whose: Where it comes from, as in ``the best pair that was simulated``.
    """
    data = champion.data
    blocks: list[Block] = [Words(f"The champion, {whose}, scores {with_unit(data.score, data.unit)}.")]
    if data.geometry is None:
        blocks.append(Words("Its simulator does not say what its designs look like."))
    else:
        caption = "The champion as it is simulated, with displacements exaggerated. Drag to turn it."
        blocks.append(Motion(caption, data.geometry, data.track))
    if data.verification is not None:
        caption = "What is left of its score with one thing changed at a time (evoframe verify)."
        blocks.append(Table(caption, verification_table(data.verification)))
    networks: list[Block] = [
        Picture(f"The network that drew its {population}.", figure.svg)
        for population, figure in champion.networks.items()
    ]
    networks += [
        Words(f"The network of {name} is not drawn: {why}.") for name, why in champion.undrawn.items()
    ]
    return [Section("Champion", blocks), Section("Networks", networks)]
