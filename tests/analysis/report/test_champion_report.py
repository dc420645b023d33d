"""Tests of the champion in a report."""

from __future__ import annotations

import attrs
import numpy as np

from evoframe import Geometry, GeometryPart, NetworkGraph, NetworkLink
from evoframe.analysis.data.champions import ChampionData, DrawnNetwork
from evoframe.analysis.page.html import Motion, Picture, Words
from evoframe.analysis.report.champion_report import champion_part

VERTICES = np.array([[[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]] * 2, np.float64)
GEOMETRY = Geometry(
    np.array([0.0, 1.0]),
    (GeometryPart("square", "#CC3311", 1.0, VERTICES, np.array([[0, 1, 2, 3]])),),
    {"tip": VERTICES[:, 2]},
)
SMALL = NetworkGraph((-1,), (0,), {0: "tanh"}, (NetworkLink(-1, 0, 1.0),))
LARGE = attrs.evolve(SMALL, links=SMALL.links * 600)
NOTHING = ChampionData(0.005, "m", None, None, (), None)


def test_a_champion_without_geometry_is_described() -> None:
    part = champion_part(NOTHING, "of a run")
    champion, networks = part.sections
    score, missing = [block.text for block in champion.blocks if isinstance(block, Words)]
    assert "of a run" in score
    assert "5 mm" in score
    assert "simulator" in missing
    assert (networks.blocks, part.files) == ([], {})


def test_body_and_networks_are_files_and_blocks() -> None:
    networks = tuple(DrawnNetwork(name, graph, (), ()) for name, graph in (("big", LARGE), ("small", SMALL)))
    part = champion_part(attrs.evolve(NOTHING, geometry=GEOMETRY, track="tip", networks=networks), "of a run")
    champion, drawn = part.sections
    assert [type(block) for block in champion.blocks] == [Words, Motion]
    picture, words = drawn.blocks
    assert isinstance(picture, Picture)
    assert picture.svg == part.files["champion-network-small.svg"]
    assert isinstance(words, Words)
    assert all(data in words.text for data in ("big", "1 nodes", "600 links"))
    assert {name.partition(".")[0] for name in part.files} == {"champion-body", "champion-network-small"}
