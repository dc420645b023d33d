"""Rows are read as they were written, and files that are not tables of rows are refused."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import attrs
import pytest
from hypothesis import HealthCheck, given, settings, strategies as st
from toy_capabilities import VARIANTS

from evoframe import InputError, RunConfig, load_run, run
from evoframe.evolution import timing_of
from evoframe.registry.registry import Plugins
from evoframe.study.plan import Cell, Planned, Study
from evoframe.study.rows import Row, read_rows, row_of, score_curve, write_rows

RESULTS = Path(__file__).parents[2] / "docs" / "results"

words = st.text(st.characters(codec="utf-8"), min_size=1, max_size=8)
finite = st.floats(allow_nan=False, allow_infinity=False)
rows = st.builds(
    Row,
    settings=st.fixed_dictionaries({"a": words, "b.c": words}),
    run=st.integers(0, 99),
    seed=st.integers(0, 2**63),
    configuration=st.just("0123"),
    evoframe=words,
    fitness=finite,
    score=finite,
    fittest_pair_score=finite,
    pairs=st.integers(0, 10**9),
    simulations=st.integers(0, 10**9),
    seconds=finite,
    champion=words,
    bit_generations=st.sampled_from(["", "simulator=2", "populations.a.evolver=3 simulator=2"]),
)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(given_rows=st.lists(rows, max_size=5))
def test_rows_are_read_as_they_were_written(tmp_path: Path, given_rows: list[Row]) -> None:
    write_rows(given_rows, tmp_path / "rows.csv")
    assert read_rows(tmp_path / "rows.csv") == given_rows


@pytest.mark.parametrize("path", sorted(RESULTS.glob("*/rows.csv")), ids=lambda path: path.parent.name)
def test_published_rows_are_written_again_byte_for_byte(tmp_path: Path, path: Path) -> None:
    write_rows(read_rows(path), tmp_path / "rows.csv")
    for name in ("rows.csv", "curves.csv"):
        assert (tmp_path / name).read_bytes() == path.with_name(name).read_bytes()


def test_a_row_has_the_figures_of_its_run(made: tuple[Study, Path, list[Planned]]) -> None:
    _, _, planned = made
    finished = load_run(planned[3].directory)
    row = row_of(planned[3], finished)
    assert row.settings == {"collaboration.n": "2", "simulator": '{"gain": 2.0, "name": "toy-varied"}'}
    assert (row.seed, row.score) == (planned[3].seed, finished.champion().score)
    assert row.champion == hashlib.sha256((finished.directory / "champion.json").read_bytes()).hexdigest()
    assert row.pairs == sum(work["pairs"] for work in finished.workload())
    last = [turn["best"] for turn in finished.turns() if turn["generation"] == 4]
    assert row.fitness == row.fitness_curve[-1] == max(last)
    assert len(row.fitness_curve) == len(row.score_curve) == 5
    assert list(row.score_curve) == sorted(row.score_curve)
    assert row.score_curve[0] == max(pair["score"] for pair in finished.pairs() if pair["turn"] == 0)


def test_a_row_has_the_bit_generations_with_which_its_run_started(
    made: tuple[Study, Path, list[Planned]],
) -> None:
    finished = load_run(made[2][0].directory)
    assert row_of(made[2][0], finished).bit_generations == ""
    finished.config["provenance"]["bit_generations"] = {"simulator": 3, "aggregator": 1, "x y": 2, "run": -1}
    row = row_of(made[2][0], finished)
    assert row.bit_generations == "simulator=3"
    assert (row.bit_generation("simulator"), row.bit_generation("aggregator")) == (3, 1)


@pytest.mark.parametrize("text", ["simulator", "simulator=0", "simulator=x", "=2", "simulator=2=3"])
def test_bit_generations_that_are_none_are_refused(
    made: tuple[Study, Path, list[Planned]], tmp_path: Path, text: str
) -> None:
    row = row_of(made[2][0], load_run(made[2][0].directory))
    write_rows([attrs.evolve(row, bit_generations=text)], tmp_path / "rows.csv")
    with pytest.raises(InputError, match=f"bit generations as in simulator=2, found {text}"):
        read_rows(tmp_path / "rows.csv")


def test_the_curve_of_scores_is_the_best_so_far_after_each_generation(
    made: tuple[Study, Path, list[Planned]],
) -> None:
    finished = load_run(made[2][0].directory)
    pairs = [(pair["turn"], pair["score"]) for pair in finished.pairs() if pair["score"] is not None]
    best = [max(score for turn, score in pairs if turn <= end) for end in range(0, 9, 2)]
    assert score_curve(finished) == tuple(best)


@pytest.mark.parametrize("name", VARIANTS)
def test_the_curves_of_a_run_have_a_value_for_each_generation(
    toy_variant: Callable[..., RunConfig], toy_plugins: Plugins, tmp_path: Path, name: str
) -> None:
    """With any timing, the last generation also has the final pair."""
    config = toy_variant(name)
    finished = run(config, out=tmp_path / "run", plugins=toy_plugins)
    row = row_of(Planned(Cell((), config), 0, tmp_path / "run"), finished)
    assert len(row.score_curve) == len(row.fitness_curve) == config.run.generations + 1
    assert row.score_curve[-1] == row.score == finished.champion().score
    turns = timing_of(config).length // config.run.generations
    for generation, fitness in enumerate(row.fitness_curve):
        assert fitness == max(
            each["best"] for each in finished.turns() if math.ceil(each["turn"] / turns) == generation
        )
    write_rows([row], tmp_path / "rows.csv")
    assert read_rows(tmp_path / "rows.csv")[0].score == row.score


def test_a_final_pair_that_is_the_best_is_part_of_the_curve(
    toy_variant: Callable[..., RunConfig], toy_plugins: Plugins, tmp_path: Path
) -> None:
    for seed in range(20):
        config = toy_variant("final pair", f"run.seed={seed}")
        finished = run(config, out=tmp_path / f"run-{seed}", plugins=toy_plugins)
        assert score_curve(finished)[-1] == finished.champion().score


def test_rows_are_also_read_without_their_curves(
    made: tuple[Study, Path, list[Planned]], tmp_path: Path
) -> None:
    row = row_of(made[2][0], load_run(made[2][0].directory))
    write_rows([row], tmp_path / "rows.csv")
    (tmp_path / "curves.csv").unlink()
    assert read_rows(tmp_path / "rows.csv") == [attrs.evolve(row, fitness_curve=(), score_curve=())]


@pytest.mark.parametrize("curve", ["a,0,score,bent", "a,0,score,nan", "a,zero,score,1"])
def test_a_line_that_is_not_a_curve_is_refused(
    made: tuple[Study, Path, list[Planned]], tmp_path: Path, curve: str
) -> None:
    write_rows([row_of(made[2][0], load_run(made[2][0].directory))], tmp_path / "rows.csv")
    (tmp_path / "curves.csv").write_text(f"aggregator,run,curve,0\n{curve}\n")
    with pytest.raises(InputError, match=curve.split(",")[1 if "zero" in curve else 3]) as caught:
        read_rows(tmp_path / "rows.csv")
    assert (caught.value.source, caught.value.key) == (str(tmp_path / "curves.csv"), "line 2")


@pytest.mark.parametrize(
    ("column", "value"), [("pairs", "-1"), ("pairs", "9" * 400), ("simulations", str(2**53 + 1))]
)
def test_a_number_of_pairs_beyond_what_tables_hold_is_refused(
    made: tuple[Study, Path, list[Planned]], tmp_path: Path, column: str, value: str
) -> None:
    row = row_of(made[2][0], load_run(made[2][0].directory))
    changes: dict[str, Any] = {column: int(value)}
    write_rows([attrs.evolve(row, **changes)], tmp_path / "rows.csv")
    with pytest.raises(InputError, match="expected a number from 0") as caught:
        read_rows(tmp_path / "rows.csv")
    assert (caught.value.source, caught.value.key) == (str(tmp_path / "rows.csv"), "line 2")


WINDOWS = Path(__file__).parents[1] / "data" / "windows"


def test_rows_that_a_windows_program_saved_are_read() -> None:
    found = read_rows(WINDOWS / "rows_bom.csv")
    assert len(found) == 20
    assert list(found[0].settings) == ["aggregator", "populations.morphology.evolver"]


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    given_rows=st.lists(rows, max_size=5, unique_by=lambda row: row.run),
    end=st.sampled_from(["\n", "\r\n", "\r"]),
    encoding=st.sampled_from(["utf-8", "utf-8-sig"]),
)
def test_marks_and_line_ends_do_not_matter(
    tmp_path: Path, given_rows: list[Row], end: str, encoding: str
) -> None:
    plain = str.maketrans("\r\n", "..")  # values with line ends of their own
    named = [
        attrs.evolve(
            row,
            settings={key: value.translate(plain) for key, value in row.settings.items()},
            evoframe=row.evoframe.translate(plain),
            champion=row.champion.translate(plain),
            fitness_curve=(row.fitness,),
        )
        for row in given_rows
    ]
    write_rows(named, tmp_path / "rows.csv")
    expected = read_rows(tmp_path / "rows.csv")
    for name in ("rows.csv", "curves.csv"):
        text = (tmp_path / name).read_bytes().decode()
        (tmp_path / name).write_bytes(text.replace("\n", end).encode(encoding))
    assert read_rows(tmp_path / "rows.csv") == expected


@pytest.mark.parametrize("name", ["rows.csv", "curves.csv"])
def test_rows_in_another_encoding_are_refused(
    made: tuple[Study, Path, list[Planned]], tmp_path: Path, name: str
) -> None:
    write_rows([row_of(made[2][0], load_run(made[2][0].directory))], tmp_path / "rows.csv")
    (tmp_path / name).write_text((tmp_path / name).read_text(), encoding="utf-16")
    with pytest.raises(InputError, match="UTF-16") as caught:
        read_rows(tmp_path / "rows.csv")
    assert caught.value.source == str(tmp_path / name)
