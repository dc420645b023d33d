"""What a study consists of."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from pathlib import Path
from typing import Any

import attrs
import pytest
import tomli_w
from toy_study import STUDY

from evoframe import ConfigurationError, run
from evoframe.evolution.coevolution import first_meetings
from evoframe.registry.discovery import discover
from evoframe.study.plan import Study, read_study, study_names
from evoframe.study.rows import Row

Read = Callable[..., Study]

THREE = """
extends = "toy.toml"
runs = 1

[grid]
"collaboration.n" = [2]
"""


def seeds(study: Study) -> dict[tuple[str, int], int]:
    return {(cell.label, index): cell.seed(index) for cell in study.cells for index in range(study.runs)}


class TestCells:
    def test_are_all_combinations_the_last_key_changing_fastest(self, toy_study: Read) -> None:
        assert [cell.label for cell in toy_study().cells] == [
            "collaboration.n=1, simulator=toy-product",
            'collaboration.n=1, simulator={"gain": 2.0, "name": "toy-varied"}',
            "collaboration.n=2, simulator=toy-product",
            'collaboration.n=2, simulator={"gain": 2.0, "name": "toy-varied"}',
        ]

    def test_have_the_settings_of_the_grid_and_of_the_base(self, toy_study: Read) -> None:
        config = toy_study().cells[3].config.tables()
        assert config["collaboration"] == {"name": "toy-first", "n": 2}
        assert config["simulator"] == {"name": "toy-varied", "limit": 1e9, "gain": 2.0}
        assert config["populations"]["a"]["size"] == 6

    def test_lie_in_folders_that_say_what_they_are(self, toy_study: Read) -> None:
        folders = [str(cell.folder) for cell in toy_study().cells]
        assert folders[0] == "collaboration.n=1/simulator=toy-product"
        assert folders[1].startswith("collaboration.n=1/simulator=toy-varied-")
        assert len(set(folders)) == 4

    def test_a_table_within_the_grid_is_a_dotted_key(self, toy_study: Read) -> None:
        text = STUDY.replace('"collaboration.n" = [1, 2]', "collaboration.n = [1, 2]")
        assert seeds(toy_study(text=text)) == seeds(toy_study())

    def test_are_those_that_are_asked_for_on_the_command_line(self, toy_study: Read) -> None:
        for override in ("grid.collaboration.n=[2]", 'grid={"collaboration.n"=[2]}'):
            assert toy_study(override).grid["collaboration.n"] == (2,)
            assert len(toy_study(override).cells) == 2

    def test_count_their_pairs_as_a_run_does(self, toy_study: Read, tmp_path: Path) -> None:
        for cell in toy_study().cells:
            made = run(cell.config, out=tmp_path / cell.folder)
            turns = cell.config.run.generations * len(cell.config.populations)
            assert cell.pairs == sum(row["pairs"] for row in made.workload() if row["turn"] <= turns)

    @pytest.mark.parametrize("sizes", [(2, 2, 3), (3, 2, 2), (2, 4, 3)])
    def test_of_three_populations_count_their_pairs_too(
        self, toy_study: Read, tmp_path: Path, sizes: tuple[int, int, int]
    ) -> None:
        populations = {
            role: {
                "size": size,
                "encoder": {"name": "toy-number", "role": role},
                "evolver": "toy-drift",
            }
            for role, size in zip("abc", sizes, strict=True)
        }
        text = tomli_w.dumps({"populations": populations})
        [cell] = toy_study("runs=1", text=f"{THREE}\n{text}").cells
        made = run(cell.config, out=tmp_path / "run")
        assert made.workload()[0]["pairs"] == len(first_meetings(sizes))
        assert cell.pairs == sum(row["pairs"] for row in made.workload() if row["turn"] <= 12)


class TestOrder:
    def test_of_work_leaves_a_partial_study_balanced(self, toy_study: Read) -> None:
        study = toy_study()
        planned = list(study.planned(Path("here")))
        assert [(run.cell.label, run.index) for run in planned] == [
            (cell.label, index) for index in range(3) for cell in study.cells
        ]
        assert len({run.directory for run in planned}) == 12
        assert str(planned[4].directory) == "here/collaboration.n=1/simulator=toy-product/01"


class TestSeeds:
    def test_are_all_different(self, toy_study: Read) -> None:
        found = seeds(toy_study())
        assert len(set(found.values())) == len(found)

    def test_of_a_cell_depend_on_no_other(self, toy_study: Read) -> None:
        few = seeds(toy_study())
        more = seeds(toy_study('grid={"collaboration.n"=[3, 2, 1]}', "runs=5"))
        assert few.items() <= more.items()

    def test_do_not_depend_on_the_order_of_the_keys(self, toy_study: Read) -> None:
        one, other = '"collaboration.n" = [1, 2]', 'simulator = ["toy-product"]'
        base = STUDY.split("[grid]")[0]
        before = seeds(toy_study(text=f"{base}[grid]\n{one}\n{other}"))
        after = seeds(toy_study(text=f"{base}[grid]\n{other}\n{one}"))
        assert next(iter(after))[0] == "simulator=toy-product, collaboration.n=1"
        assert sorted(before.values()) == sorted(after.values())

    def test_are_those_of_the_study(self, toy_study: Read) -> None:
        ours, others = seeds(toy_study()), seeds(toy_study("run.seed=8"))
        assert not set(ours.values()) & set(others.values())


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (("runs = 3", ""), "study.toml: runs: is missing"),
        (("runs = 3", "runs = 0"), "runs: expected a whole number from 1 up, found 0"),
        (("runs = 3", "runs = true"), "runs: expected a whole number from 1 up, found true"),
        (("[1, 2]", "[]"), "grid.collaboration.n: expected different values, found"),
        (("[1, 2]", "[1, 1]"), "grid.collaboration.n: expected different values, found"),
        (("[1, 2]", "2"), "grid.collaboration.n: expected a list of values, found 2"),
        (
            ("[1, 2]", "[1, 9]"),
            "study.toml: grid: collaboration.n=9: collaboration: 9 collaborators of 6 members",
        ),
        (
            ('"collaboration.n"', '"collaboration.m"'),
            "grid: collaboration.m=1: collaboration.m: unknown option",
        ),
        (('"collaboration.n"', '"run.seed"'), "grid: run.seed: seeds are derived"),
        (
            ('"collaboration.n" = [1, 2]', "run = [{ generations = 2 }, { seed = 4 }]"),
            "grid: run: is a column of the study's tables already; give its settings one by one",
        ),
        (("[1, 2]", '[1, "1"]'), 'grid.collaboration.n: expected different values, found [1, "1"]'),
        (('"collaboration.n"', '"a b"'), "grid: 'a b' is no key"),
        (("[grid]", "[grit]"), "study.toml: grid: is missing"),
        (
            ('"collaboration.n"', '"simulator.gain"'),
            "grid: simulator.gain: is a part of simulator",
        ),
        (("runs = 3", "runs = 1000000"), "a study of 4000000 runs; at most 1000000"),
    ],
)
def test_mistakes_are_named(toy_study: Read, change: tuple[str, str], message: str) -> None:
    with pytest.raises(ConfigurationError) as caught:
        toy_study(text=STUDY.replace(*change))
    assert message in str(caught.value)


@pytest.mark.parametrize("column", [*attrs.fields_dict(Row), "curve"])
def test_no_key_of_a_grid_is_called_like_a_column(toy_study: Read, column: str) -> None:
    with pytest.raises(ConfigurationError):
        toy_study(text=STUDY.replace('"collaboration.n" = [1, 2]', f"{column} = [{{ generations = 2 }}]"))


def test_a_study_that_is_nowhere_is_said_to_be(toy_plugins: Any) -> None:
    with pytest.raises(ConfigurationError, match=r"nowhere\.toml: cannot be read"):
        read_study("nowhere.toml", (), toy_plugins)
    with pytest.raises(ConfigurationError, match=r"there is no study 'papre'; did you mean 'paper'\?"):
        read_study("papre", (), toy_plugins)


class TestBuiltIn:
    def test_ones_have_names(self) -> None:
        assert study_names() == ["authors-rates", "collaborators", "paper", "small"]

    def test_paper_is_that_of_the_paper(self) -> None:
        study = read_study("paper", (), discover())
        averages, counts = ("am", "wm", "gm", "hm"), (2, 3, 5, 7, 10)
        assert study.grid == {"collaboration.n": counts, "aggregator": averages}
        assert (len(study.cells), study.runs) == (20, 30)
        pairs = sum(cell.pairs * study.runs for cell in study.cells)
        assert pairs == sum((625 + 400 * 25 * n) * 30 for n, _ in itertools.product(counts, averages))

    @pytest.mark.parametrize("name", study_names())
    def test_ones_are_valid(self, name: str) -> None:
        assert len(read_study(name, (), discover()).cells) >= 4
