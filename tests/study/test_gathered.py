"""Rows of a study: those of its own runs, and imported ones."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import attrs
import pytest
import toys

from evoframe import InputError, load_run, run
from evoframe.study.conduct import claim, survey
from evoframe.study.gathered import gather, import_rows, imported_rows, mixed_generations
from evoframe.study.plan import Planned, Study
from evoframe.study.progress import record_failure
from evoframe.study.rows import Row, read_rows, row_of, write_rows

Read = Callable[..., Study]


def kept(study: Study, directory: Path) -> list[Row]:
    imported = imported_rows(study, directory)
    rows = list(gather(survey(study, directory, imported), imported).values())
    write_rows(rows, directory / "rows.csv")
    return rows


def test_imported_rows_count_as_finished(
    made: tuple[Study, Path, list[Planned]], toy_study: Read, tmp_path: Path
) -> None:
    study, directory, _ = made
    gathered = kept(study, directory)
    there = tmp_path / "there"
    there.mkdir()
    import_rows(study, there, [directory / "rows.csv"])
    again = kept(study, there)
    assert [attrs.evolve(row, fitness_curve=(), score_curve=()) for row in again] == [
        attrs.evolve(row, fitness_curve=(), score_curve=()) for row in gathered
    ]
    for row, other in zip(gathered, again, strict=True):
        assert other.fitness_curve == pytest.approx(row.fitness_curve, rel=1e-5)
    assert (there / "rows.csv").read_bytes() == (directory / "rows.csv").read_bytes()
    assert (there / "curves.csv").read_bytes() == (directory / "curves.csv").read_bytes()


def test_imported_rows_replace_runs_that_are_not_finished_here(
    made: tuple[Study, Path, list[Planned]], tmp_path: Path
) -> None:
    study, directory, planned = made
    gathered = kept(study, directory)
    there = tmp_path / "there"
    claim(study, there)
    failed, begun, missing, finished = study.planned(there)
    record_failure(failed.directory, "a fault")
    begun.directory.mkdir(parents=True)
    shutil.copy(planned[1].directory / "config.toml", begun.directory)
    shutil.copytree(planned[3].directory, finished.directory)
    assert [status.state for status in survey(study, there).values()] == [
        "failed", "begun", "missing", "finished",
    ]  # fmt: skip
    import_rows(study, there, [directory / "rows.csv"])
    imported = imported_rows(study, there)
    statuses = survey(study, there, imported)
    assert [statuses[run].state for run in (failed, begun, missing)] == ["imported"] * 3
    rows = gather(statuses, imported)
    assert [row.champion for row in rows.values()] == [row.champion for row in gathered]
    assert rows[finished] == gathered[3]  # with all digits of its curves, not six


@pytest.mark.parametrize(
    ("change", "key", "problem"),
    [
        (
            ("toy-product,0,", "toy-product,7,"),
            "collaboration.n=1, simulator=toy-product, run 7",
            "no such run",
        ),
        (("toy-product,0,", "toy-other,0,"), "collaboration.n=1, simulator=toy-other, run 0", "no such run"),
        (("toy-product,0,", "toy-product,0,1"), "collaboration.n=1, simulator=toy-product, run 0", "seed 1"),
        (("toy-product,0,", "toy-product,zero,"), "line 2", "'zero'"),
        (("toy-product,0,", "toy-product,0,,"), "", "lines"),
        (("run,seed", "run,seeds"), "", "seed"),
        ((",0.1.0,", ",0.1.0,nan,"), "", "lines"),
    ],
)
def test_rows_of_something_else_are_refused(
    made: tuple[Study, Path, list[Planned]], change: tuple[str, str], key: str, problem: str
) -> None:
    study, directory, _ = made
    kept(study, directory)
    path = directory / "rows.csv"
    path.write_text(path.read_text().replace(*change))
    with pytest.raises(InputError) as caught:
        import_rows(study, directory, [path])
    assert (caught.value.source, caught.value.key) == (str(path), key)
    assert problem in caught.value.problem


def test_rows_of_cells_that_are_not_requested_now_are_kept(
    made: tuple[Study, Path, list[Planned]], toy_study: Read, tmp_path: Path
) -> None:
    study, directory, planned = made
    kept(study, directory)
    there = tmp_path / "there"
    there.mkdir()
    import_rows(study, there, [directory / "rows.csv"])
    fewer = toy_study("runs=1", "grid.collaboration.n=[2]")
    assert [run.index for run in imported_rows(fewer, there)] == [0, 0]
    write_rows([row_of(planned[2], load_run(planned[2].directory))], tmp_path / "rows.csv")
    import_rows(fewer, there, [tmp_path / "rows.csv"])
    assert len(imported_rows(study, there)) == 4


def test_rows_that_contradict_each_other_are_refused(made: tuple[Study, Path, list[Planned]]) -> None:
    study, directory, _ = made
    rows = kept(study, directory)
    import_rows(study, directory, [directory / "rows.csv"])
    write_rows([attrs.evolve(rows[0], champion="other")], directory / "rows.csv")
    with pytest.raises(InputError, match=r"champion was \w{64}, is other$") as caught:
        import_rows(study, directory, [directory / "rows.csv"])
    assert caught.value.key.endswith(", run 0")


def changed(path: Path, change: Callable[[list[str]], list[str]]) -> None:
    path.write_text("\n".join([*change(path.read_text().splitlines()), ""]))


def test_a_score_that_is_not_a_number_is_refused(made: tuple[Study, Path, list[Planned]]) -> None:
    study, directory, _ = made
    [row, *_] = kept(study, directory)
    path = directory / "rows.csv"
    path.write_text(path.read_text().replace(f",{row.score!r},", ",nan,", 1))
    with pytest.raises(InputError, match="found nan") as caught:
        import_rows(study, directory, [path])
    assert (caught.value.source, caught.value.key) == (str(path), "line 2")


def test_curves_that_are_cut_are_refused(made: tuple[Study, Path, list[Planned]]) -> None:
    study, directory, _ = made
    kept(study, directory)
    changed(directory / "curves.csv", lambda lines: [line.rpartition(",")[0] for line in lines])
    with pytest.raises(InputError, match=r"rows\.csv, line \d: the (fitness|score)") as caught:
        import_rows(study, directory, [directory / "rows.csv"])
    assert caught.value.source == str(directory / "curves.csv")


def test_rows_of_runs_of_different_lengths_are_read_again(toy_study: Read, tmp_path: Path) -> None:
    study = toy_study(text='extends = "toy.toml"\nruns = 1\n[grid]\n"run.generations" = [1, 3]\n')
    directory = tmp_path / "here"
    for each in study.planned(directory):
        config = each.cell.config
        run(attrs.evolve(config, run=attrs.evolve(config.run, seed=each.seed)), out=each.directory)
    rows = kept(study, directory)
    assert sorted(len(row.fitness_curve) for row in rows) == [2, 4]
    again = read_rows(directory / "rows.csv")
    assert [len(row.score_curve) for row in again] == [len(row.score_curve) for row in rows]


def test_curves_can_be_imported_later(made: tuple[Study, Path, list[Planned]], tmp_path: Path) -> None:
    study, directory, _ = made
    kept(study, directory)
    there, curves = tmp_path / "there", directory / "curves.csv"
    claim(study, there)
    text = curves.read_text()
    changed(curves, lambda lines: lines[:2])  # one of the two curves of one run
    import_rows(study, there, [directory / "rows.csv"])
    lengths = [len(row.fitness_curve) for row in imported_rows(study, there).values()]
    assert sorted(lengths) == [0, 0, 0, 5]
    curves.write_text(text)
    import_rows(study, there, [directory / "rows.csv"])
    assert {len(row.fitness_curve) for row in imported_rows(study, there).values()} == {5}


def test_a_table_that_contradicts_imported_rows_is_refused(
    made: tuple[Study, Path, list[Planned]], tmp_path: Path
) -> None:
    study, directory, _ = made
    first, *others = kept(study, directory)
    there = tmp_path / "there"
    claim(study, there)
    import_rows(study, there, [directory / "rows.csv"])
    other = attrs.evolve(first, fittest_pair_score=first.fittest_pair_score + 1.0, seconds=9.0)
    write_rows([other, *others], tmp_path / "rows.csv")
    with pytest.raises(InputError) as caught:
        import_rows(study, there, [tmp_path / "rows.csv"])
    assert caught.value.source == str(tmp_path / "rows.csv")
    assert caught.value.key.endswith(", run 0")
    assert f"fittest_pair_score was {first.fittest_pair_score}, " in caught.value.problem
    assert "seconds" not in caught.value.problem


@pytest.mark.parametrize("text", ["", "garbage\n", "run,seed\n"])
def test_a_file_that_is_not_a_table_of_rows_is_refused(
    made: tuple[Study, Path, list[Planned]], tmp_path: Path, text: str
) -> None:
    study, directory, _ = made
    (tmp_path / "rows.csv").write_text(text)
    with pytest.raises(InputError, match="missing columns: ") as caught:
        import_rows(study, directory, [tmp_path / "rows.csv"])
    assert caught.value.source == str(tmp_path / "rows.csv")


class TestBitGenerations:
    def test_are_named_if_results_contradict_each_other(
        self, made: tuple[Study, Path, list[Planned]], tmp_path: Path
    ) -> None:
        study, directory, _ = made
        first, *others = kept(study, directory)
        there = tmp_path / "there"
        claim(study, there)
        import_rows(study, there, [directory / "rows.csv"])
        newer = attrs.evolve(first, bit_generations="simulator=2")
        write_rows([newer, *others], tmp_path / "rows.csv")
        import_rows(study, there, [tmp_path / "rows.csv"])  # the same results
        assert {row.bit_generations for row in imported_rows(study, there).values()} == {""}
        write_rows([attrs.evolve(newer, score=first.score + 1e-9), *others], tmp_path / "rows.csv")
        with pytest.raises(InputError, match=r"; bit_generations was 1, is simulator=2$"):
            import_rows(study, there, [tmp_path / "rows.csv"])

    def test_that_differ_between_runs_are_listed(
        self, made: tuple[Study, Path, list[Planned]], monkeypatch: pytest.MonkeyPatch
    ) -> None:
        study, directory, planned = made
        rows = gather(survey(study, directory), {})
        assert [run.cell.config.simulator.name for run in planned] == ["toy-product", "toy-varied"] * 2
        newer = "simulator=3"
        assert mixed_generations(rows) == []
        changed = {run: attrs.evolve(row, bit_generations=newer) for run, row in rows.items()}
        assert mixed_generations(changed) == []
        assert mixed_generations({**rows, planned[1]: changed[planned[1]]}) == [
            "simulator 'toy-varied': 1 and 3"
        ]
        missing = planned[0]
        others = {run: row for run, row in rows.items() if run != missing}
        assert mixed_generations(others, [missing]) == []
        monkeypatch.setattr(toys.Product, "bit_generation", 2, raising=False)
        assert mixed_generations(rows) == []
        assert mixed_generations(others, [missing]) == ["simulator 'toy-product': 1 and 2"]
