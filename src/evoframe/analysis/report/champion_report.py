"""The champion in a report: figures of its body and networks, and sections of the page."""

from __future__ import annotations

from evoframe.analysis.data.champions import ChampionData
from evoframe.analysis.data.tables import verification_table
from evoframe.analysis.figures.bodies import body
from evoframe.analysis.figures.networks import TooLargeError, network
from evoframe.analysis.output.writing import figure_files, table_files
from evoframe.analysis.page.html import Block, Motion, Part, Picture, Section, Table, Words
from evoframe.messages import quantity

__all__ = ["champion_part"]


def champion_part(data: ChampionData, whose: str) -> Part:
    """Return the sections and files that show a champion.

    Args:
        data: The champion.
        whose: Origin of the champion, as in ``the best pair of the run``.
    """
    score, files = quantity(data.score, data.unit), dict[str, bytes]()
    blocks: list[Block] = [Words(f"The champion, {whose}, scores {score}.")]
    if data.geometry is None:
        blocks.append(Words("Its simulator does not support geometries, so the body is not drawn."))
    else:
        caption = "Simulated motion of the champion, with exaggerated displacements. Drag to rotate."
        blocks.append(Motion(caption, data.geometry, data.track, data.samples))
        files |= figure_files(body(data.geometry, score), "champion-body")
    if data.verification is not None:
        table = verification_table(data.verification)
        caption = "Score of the champion with one setting changed at a time (evoframe verify)."
        blocks.append(Table(caption, table))
        files |= table_files(table, "verification")
    networks: list[Block] = []
    undrawn: list[Block] = []
    for each in data.networks:
        try:
            figure = network(each.graph, each.inputs, each.outputs, each.population)
        except TooLargeError as error:
            undrawn.append(Words(f"The network of {each.population} is not drawn: {error}."))
        else:
            name = f"champion-network-{each.population}"
            files |= figure_files(figure, name)
            networks.append(
                Picture(f"Network that encodes the {each.population} of the champion.", files[f"{name}.svg"])
            )
    return Part([Section("Champion", blocks), Section("Networks", [*networks, *undrawn])], files)
