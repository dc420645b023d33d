"""Cells, seeds and directories of studies, and the errors in their files."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from pathlib import Path
from typing import Any

import attrs
import pytest
import tomli_w
from toy_capabilities import VARIANTS
from toy_study import STUDY

from evoframe import ConfigurationError, Layer, RunConfig, run
from evoframe.evolution import first_meetings, timing_of
from evoframe.registry.discovery import discover
from evoframe.registry.registry import Plugins
from evoframe.study.plan import Cell, Study, read_study, study_names
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

    def test_have_folders_named_after_their_settings(self, toy_study: Read) -> None:
        folders = [str(cell.folder) for cell in toy_study().cells]
        assert folders[0] == "collaboration.n=1/simulator=toy-product"
        assert folders[1].startswith("collaboration.n=1/simulator=toy-varied-")
        assert len(set(folders)) == 4

    def test_a_table_within_the_grid_is_a_dotted_key(self, toy_study: Read) -> None:
        text = STUDY.replace('"collaboration.n" = [1, 2]', "collaboration.n = [1, 2]")
        assert seeds(toy_study(text=text)) == seeds(toy_study())

    def test_have_the_values_that_an_override_sets_for_a_key(self, toy_study: Read) -> None:
        study = toy_study("grid.collaboration.n=[2]")
        assert study.grid["collaboration.n"] == (2,)
        assert set(study.grid) == {"collaboration.n", "simulator"}
        assert len(study.cells) == 2

    @pytest.mark.parametrize(
        "overrides",
        [
            ['grid={"collaboration.n"=[2]}'],
            [" grid = {collaboration.n=[2]}"],
            [Layer("grid={'collaboration.n': [2]}", {"grid": {"collaboration.n": [2]}})],
            ["grid={aggregator=['toy-mean']}", 'grid={"collaboration.n"=[2]}'],
            ["grid.aggregator=['toy-mean']", 'grid={"collaboration.n"=[2]}'],
            ["grid={}", "grid.collaboration.n=[2]"],
        ],
    )
    def test_are_those_of_the_whole_grid_that_an_override_sets(
        self, toy_study: Read, overrides: list[Any]
    ) -> None:
        study = toy_study(*overrides)
        assert study.grid == {"collaboration.n": (2,)}
        assert len(study.cells) == 1

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

    @pytest.mark.parametrize(
        "name",
        [name for name in VARIANTS if "asynchronous" not in name],  # whose populations have drawn turns
    )
    def test_count_the_pairs_and_individuals_of_any_timing(
        self, toy_variant: Callable[..., RunConfig], toy_plugins: Plugins, tmp_path: Path, name: str
    ) -> None:
        """At most: two individuals that reproduce together can choose each other."""
        config = toy_variant(name)
        made = run(config, out=tmp_path / "run", plugins=toy_plugins)
        cell, last = Cell((), config), timing_of(config).length
        pairs = sum(row["pairs"] for row in made.workload() if row["turn"] <= last)
        assert cell.individuals == len(made.individuals())
        assert pairs <= cell.pairs
        if "parallel" not in name and "numbers" not in name:
            assert pairs == cell.pairs


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
        more = seeds(toy_study("grid.collaboration.n=[3, 2, 1]", "runs=5"))
        assert few.items() <= more.items()

    def test_do_not_depend_on_the_order_of_the_keys(self, toy_study: Read) -> None:
        one, other = '"collaboration.n" = [1, 2]', 'simulator = ["toy-product"]'
        base = STUDY.split("[grid]")[0]
        before = seeds(toy_study(text=f"{base}[grid]\n{one}\n{other}"))
        after = seeds(toy_study(text=f"{base}[grid]\n{other}\n{one}"))
        assert next(iter(after))[0] == "simulator=toy-product, collaboration.n=1"
        assert sorted(before.values()) == sorted(after.values())

    def test_are_those_of_the_study(self, toy_study: Read) -> None:
        first, second = seeds(toy_study()), seeds(toy_study("run.seed=8"))
        assert not set(first.values()) & set(second.values())


@pytest.mark.parametrize(
    ("change", "key", "problem"),
    [
        (("runs = 3", ""), "runs", "runs = "),
        (("runs = 3", "runs = 0"), "runs", "found 0"),
        (("runs = 3", "runs = true"), "runs", "found true"),
        (("[1, 2]", "[]"), "grid.collaboration.n", "found []"),
        (("[1, 2]", "[1, 1]"), "grid.collaboration.n", "found [1, 1]"),
        (("[1, 2]", "2"), "grid.collaboration.n", "found 2"),
        (('"collaboration.n"', '"run.seed"'), "grid.run.seed", "runs = "),
        (
            ('"collaboration.n" = [1, 2]', "run = [{ generations = 2 }, { seed = 4 }]"),
            "grid.run",
            "run.generations = [",
        ),
        (("[1, 2]", '[1, "1"]'), "grid.collaboration.n", 'found [1, "1"]'),
        (('"collaboration.n"', '"a b"'), "grid.a b", "not a key"),
        (("[grid]", "[grit]"), "grid", "aggregator = ["),
        (('"collaboration.n"', '"simulator.gain"'), "grid.simulator.gain", "'simulator'"),
        (("runs = 3", "runs = 1000000"), "", " 4000000 "),
    ],
)
def test_errors_name_file_and_key(toy_study: Read, change: tuple[str, str], key: str, problem: str) -> None:
    with pytest.raises(ConfigurationError) as caught:
        toy_study(text=STUDY.replace(*change))
    assert caught.value.source.endswith("study.toml")
    assert caught.value.key == key
    assert problem in caught.value.problem


@pytest.mark.parametrize(
    ("change", "setting", "key"),
    [
        (("[1, 2]", "[1, 9]"), "collaboration.n=9", "collaboration"),
        (('"collaboration.n"', '"collaboration.m"'), "collaboration.m=1", "collaboration.m"),
    ],
)
def test_errors_in_a_cell_name_its_setting(
    toy_study: Read, change: tuple[str, str], setting: str, key: str
) -> None:
    with pytest.raises(ConfigurationError) as caught:
        toy_study(text=STUDY.replace(*change))
    assert f"study.toml: grid: {setting}: {key}: " in str(caught.value)


@pytest.mark.parametrize("column", [*attrs.fields_dict(Row), "curve"])
def test_no_key_of_a_grid_is_named_like_a_column(toy_study: Read, column: str) -> None:
    with pytest.raises(ConfigurationError):
        toy_study(text=STUDY.replace('"collaboration.n" = [1, 2]', f"{column} = [{{ generations = 2 }}]"))


def test_a_study_that_does_not_exist_is_named(toy_plugins: Any) -> None:
    with pytest.raises(ConfigurationError, match=r"nowhere\.toml"):
        read_study("nowhere.toml", (), toy_plugins)
    with pytest.raises(ConfigurationError, match=r"papre: .*'paper'"):
        read_study("papre", (), toy_plugins)


def test_overrides_are_a_list(toy_plugins: Any) -> None:
    with pytest.raises(TypeError):
        read_study("small", "runs=2", toy_plugins)


class TestBuiltIn:
    def test_ones_have_names(self) -> None:
        assert study_names() == ["authors-rates", "collaborators", "paper", "small"]

    def test_paper_has_the_published_grid(self) -> None:
        study = read_study("paper", (), discover())
        averages, counts = ("am", "wm", "gm", "hm"), (2, 3, 5, 7, 10)
        assert study.grid == {"collaboration.n": counts, "aggregator": averages}
        assert (len(study.cells), study.runs) == (20, 30)
        pairs = sum(cell.pairs * study.runs for cell in study.cells)
        assert pairs == sum((625 + 400 * 25 * n) * 30 for n, _ in itertools.product(counts, averages))

    @pytest.mark.parametrize("name", study_names())
    def test_ones_are_valid(self, name: str) -> None:
        assert len(read_study(name, (), discover()).cells) >= 4
