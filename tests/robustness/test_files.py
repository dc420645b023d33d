"""What was written is read back exactly, and nothing else is taken for it."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import attrs
import numpy as np
import pytest
from hypothesis import given, strategies as st
from measuring import measure

from evoframe import InputError, Robustness
from evoframe.analysis.robustness import as_json, find, write_robustness
from evoframe.robustness import files
from evoframe.robustness.files import read_robustness, refuse_another

NAMES = {
    "scores.csv", "robustness.json", "conclusions.txt", "violins.pdf", "violins.svg", "violins.png",
    *(f"{name}.{ending}" for name in ("groups", "bodies", "pairs", "ranking") for ending in ("csv", "tex")),
}  # fmt: skip


def contents(directory: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in directory.iterdir()}


@pytest.fixture(scope="module")
def measured() -> Robustness:
    return measure([1.0, 2.0, 3.0], 20, most=1.5, groups="XXY")


@pytest.fixture(scope="module")
def original(measured: Robustness, tmp_path_factory: pytest.TempPathFactory) -> Path:
    directory = tmp_path_factory.mktemp("original")
    write_robustness(find(measured), directory)
    return directory


@pytest.fixture
def written(original: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(original, tmp_path / "here"))


def test_all_files_are_named_and_the_same_every_time(
    measured: Robustness, written: Path, tmp_path: Path
) -> None:
    paths = write_robustness(find(measured), tmp_path / "there")
    assert set(contents(written)) == NAMES == {path.name for path in paths}
    assert contents(tmp_path / "there") == contents(written)


@pytest.mark.parametrize(("numbers", "most"), [([1.0], 9.0), ([1.0, 2.0], -9.0)])
def test_they_are_the_same_where_nothing_can_be_compared(
    tmp_path: Path, numbers: list[float], most: float
) -> None:
    measured = measure(numbers, 3, most=most)
    write_robustness(find(measured), tmp_path)
    assert set(contents(tmp_path)) == NAMES
    assert_same(read_robustness(tmp_path), measured)


def assert_same(one: Robustness, other: Robustness) -> None:
    assert one.setting == other.setting
    assert [body.source for body in one.setting.bodies] == [body.source for body in other.setting.bodies]
    assert one.diverged == other.diverged
    assert np.array_equal(one.scores, other.scores, equal_nan=True)


@given(st.lists(st.floats(0.5, 4.0), min_size=1, max_size=4), st.floats(-1.0, 4.0), st.integers(0, 2**40))
def test_it_is_read_back_exactly(
    tmp_path_factory: pytest.TempPathFactory, numbers: list[float], most: float, seed: int
) -> None:
    directory = tmp_path_factory.mktemp("measured")
    measured = measure(numbers, 5, most=most, seed=seed, unit="m")
    (directory / files.SETTING_FILE).write_text(json.dumps(files.document_of(measured)))
    (directory / files.SCORES_FILE).write_text(files.scores_text(measured))
    assert_same(read_robustness(directory), measured)


def test_what_is_written_is_named_and_read_back(measured: Robustness, tmp_path: Path) -> None:
    paths = files.write_measurement(measured, tmp_path)
    assert [path.name for path in paths] == [files.SCORES_FILE, files.SETTING_FILE]
    assert set(tmp_path.iterdir()) == set(paths)
    assert_same(read_robustness(tmp_path), measured)


def test_json_has_everything(measured: Robustness) -> None:
    document = json.loads(json.dumps(as_json(find(measured)), allow_nan=False))
    scores = np.array(document["scores"], dtype=np.float64)
    assert np.array_equal(scores, measured.scores, equal_nan=True)
    assert [body["label"] for body in document["bodies"]] == ["A", "B", "C"]
    assert set(document["tables"]) == {"groups", "bodies", "pairs", "ranking"}
    assert document["diverged"][0]["step"] == 7
    assert document["conclusions"].startswith("3 bodies with 20 controllers")


class TestOccupied:
    def test_by_the_same_measurement_is_welcome(self, measured: Robustness, written: Path) -> None:
        moved = [attrs.evolve(body, source="elsewhere") for body in measured.setting.bodies]
        refuse_another(written, attrs.evolve(measured.setting, bodies=tuple(moved)))

    def test_by_nothing_is_welcome(self, measured: Robustness, tmp_path: Path) -> None:
        refuse_another(tmp_path / "missing", measured.setting)
        refuse_another(tmp_path, measured.setting)

    @pytest.mark.parametrize(
        ("change", "line"),
        [
            (lambda s: attrs.evolve(s, seed=2), "seed: 1 then, 2 now"),
            (lambda s: attrs.evolve(s, controllers=21), "controllers: 20 then, 21 now"),
            (
                lambda s: attrs.evolve(s, simulation={"simulator": {"name": "vox"}}),
                "simulation.simulator.name: 'toy-steered' then, 'vox' now",
            ),
            (lambda s: attrs.evolve(s, bodies=s.bodies[:2]), " in group 2' then, 'nothing' now"),
            (
                lambda s: attrs.evolve(s, bodies=(*s.bodies[:2], attrs.evolve(s.bodies[2], digest="0"))),
                " in group 2' then, '0 in group 2' now",
            ),
        ],
    )
    def test_by_another_measurement_is_refused_unless_forced(
        self, measured: Robustness, written: Path, change: Callable[[Any], Any], line: str
    ) -> None:
        other = change(measured.setting)
        with pytest.raises(InputError, match=r"was measured otherwise; use --out, or --force") as caught:
            refuse_another(written, other)
        assert line in str(caught.value)
        refuse_another(written, other, force=True)

    def test_by_the_same_bodies_under_other_names_is_no_other(
        self, measured: Robustness, written: Path
    ) -> None:
        moved = [attrs.evolve(body, label=f"moved/{body.label}") for body in measured.setting.bodies]
        refuse_another(written, attrs.evolve(measured.setting, bodies=tuple(moved)))
        with pytest.raises(InputError, match=r"bodies\.1: '.* in group 1' then, '.* in group 1' now"):
            refuse_another(written, attrs.evolve(measured.setting, bodies=tuple(reversed(moved))))

    def test_by_a_damaged_measurement_is_refused_unless_forced(
        self, measured: Robustness, written: Path
    ) -> None:
        (written / "robustness.json").write_text("{")
        with pytest.raises(InputError, match=r"robustness.json: not valid JSON"):
            refuse_another(written, measured.setting)
        refuse_another(written, measured.setting, force=True)

    def test_by_something_else_is_refused_always(self, measured: Robustness, tmp_path: Path) -> None:
        (tmp_path / "letter.txt").write_text("Dear")
        for force in (False, True):
            with pytest.raises(InputError, match=r"is not empty, and not the directory of a measurement"):
                refuse_another(tmp_path, measured.setting, force=force)


class TestDamage:
    def test_of_nothing_is_said(self, tmp_path: Path) -> None:
        with pytest.raises(InputError, match=r"is no measurement of robustness: there is no robustness.json"):
            read_robustness(tmp_path)

    def test_of_scores_that_belong_to_another_setting_is_refused(self, written: Path) -> None:
        path = written / "scores.csv"
        first, second, *others = path.read_text().splitlines()
        path.write_text("\n".join([first, second.replace(",", ",1", 1), *others]) + "\n")
        with pytest.raises(InputError, match=r"is not the measurement that robustness\.json describes"):
            read_robustness(written)

    @pytest.mark.parametrize(
        ("damage", "message"),
        [
            (lambda d: [d], "this JSON is no measurement"),
            (lambda d: {**d, "format": 2}, "format 2, but this evoframe reads format 1"),
            (lambda d: {**d, "format": True}, "format True, but"),
            (lambda d: {**d, "seed": "1"}, "not as evoframe writes it: seed: expected a whole number"),
            (lambda d: {**d, "seed": True}, "seed: expected a whole number, found true"),
            (lambda d: {**d, "controllers": 0}, "controllers: must be >= 1, found 0"),
            (lambda d: {**d, "controllers": 10**9}, "expected a line for each of 1000000000 controllers"),
            (lambda d: {**d, "unit": 3}, "unit: expected a string, found 3"),
            (lambda d: {**d, "simulation": []}, "simulation: expected a table, found []"),
            (lambda d: {**d, "bodies": []}, "bodies: expected at least one"),
            (lambda d: {**d, "bodies": 3}, "bodies: expected a list, found 3"),
            (
                lambda d: {**d, "bodies": [{**d["bodies"][0], "label": []}]},
                "bodies[0].label: expected a string",
            ),
            (lambda d: {**d, "bodies": [d["bodies"][0]] * 3, "diverged": []}, "different labels"),
            (lambda d: {**d, "more": 1}, "more: unknown option"),
            (
                lambda d: {**d, "diverged": [{**d["diverged"][0], "step": -1}]},
                "diverged[0].step: must be >= 0",
            ),
            (
                lambda d: {**d, "diverged": [{**d["diverged"][0], "body": "Z"}]},
                "'Z' is not one of the bodies",
            ),
            (lambda d: {**d, "diverged": []}, "scores are missing elsewhere than robustness.json says"),
        ],
    )
    def test_of_the_setting_is_refused(
        self, written: Path, damage: Callable[[Any], Any], message: str
    ) -> None:
        path = written / "robustness.json"
        path.write_text(json.dumps(damage(json.loads(path.read_text()))))
        with pytest.raises(InputError) as caught:
            read_robustness(written)
        assert message in str(caught.value)

    @pytest.mark.parametrize(
        ("damage", "message"),
        [
            (lambda lines: [], "not as evoframe writes it"),
            (lambda lines: lines[1:], "its columns are not the bodies of robustness.json"),
            (lambda lines: lines[:-1], "expected a line for each of 20 controllers"),
            (lambda lines: [lines[0], lines[2], lines[1], *lines[3:]], "expected a line for each of 20"),
            (lambda lines: [lines[0], "", *lines[1:]], "expected a line for each of 20"),
            (lambda lines: [*lines[:-1], f"{lines[-1]},1.0"], "expected 3 scores, found 4"),
            (lambda lines: [*lines[:-1], "19,1.0,nan,1.0"], "nan is no score"),
            (lambda lines: [*lines[:-1], "19,1.0,much,1.0"], "could not convert"),
        ],
    )
    def test_of_the_scores_is_refused(
        self, written: Path, damage: Callable[[list[str]], list[str]], message: str
    ) -> None:
        path = written / "scores.csv"
        path.write_text("\n".join(damage(path.read_text().splitlines())))
        with pytest.raises(InputError) as caught:
            read_robustness(written)
        assert str(caught.value).startswith(f"{path}: not as evoframe writes it: ")
        assert message in str(caught.value)
