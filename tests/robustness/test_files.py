"""Measurements are read exactly as they were written, and damaged ones are refused."""

from __future__ import annotations

import json
import re
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
def test_all_files_are_written_if_nothing_can_be_compared(
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
def test_a_measurement_is_read_exactly_as_written(
    tmp_path_factory: pytest.TempPathFactory, numbers: list[float], most: float, seed: int
) -> None:
    directory = tmp_path_factory.mktemp("measured")
    measured = measure(numbers, 5, most=most, seed=seed, unit="m")
    (directory / files.SETTING_FILE).write_text(json.dumps(files.document_of(measured)))
    (directory / files.SCORES_FILE).write_text(files.scores_text(measured))
    assert_same(read_robustness(directory), measured)


def test_written_files_are_returned_and_can_be_read(measured: Robustness, tmp_path: Path) -> None:
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
    assert {"3", "20"} <= set(re.findall(r"\d+", document["conclusions"]))


class TestOccupied:
    def test_by_the_same_measurement_is_accepted(self, measured: Robustness, written: Path) -> None:
        moved = [attrs.evolve(body, source="elsewhere") for body in measured.setting.bodies]
        refuse_another(written, attrs.evolve(measured.setting, bodies=tuple(moved)))

    def test_by_nothing_is_accepted(self, measured: Robustness, tmp_path: Path) -> None:
        refuse_another(tmp_path / "missing", measured.setting)
        refuse_another(tmp_path, measured.setting)

    @pytest.mark.parametrize(
        ("change", "line"),
        [
            (lambda s: attrs.evolve(s, seed=2), r"seed: 1\b.*\b2\b"),
            (lambda s: attrs.evolve(s, controllers=21), r"controllers: 20\b.*\b21\b"),
            (
                lambda s: attrs.evolve(s, simulation={"simulator": {"name": "vox"}}),
                r"simulation\.simulator\.name: 'toy-steered'.*'vox'",
            ),
            (lambda s: attrs.evolve(s, bodies=s.bodies[:2]), r"bodies\.3: '\w{16} in group 2'(?!.*group)"),
            (
                lambda s: attrs.evolve(s, bodies=(*s.bodies[:2], attrs.evolve(s.bodies[2], digest="0"))),
                r"bodies\.C: '\w{16} in group 2'.*'0 in group 2'",
            ),
        ],
    )
    def test_by_another_measurement_is_refused_unless_forced(
        self, measured: Robustness, written: Path, change: Callable[[Any], Any], line: str
    ) -> None:
        other = change(measured.setting)
        with pytest.raises(InputError) as caught:
            refuse_another(written, other)
        assert caught.value.source == str(written / files.SETTING_FILE)
        first, *lines = caught.value.problem.splitlines()
        assert "--out" in first
        assert "--force" in first
        assert any(re.match(line, each.strip()) for each in lines)
        refuse_another(written, other, force=True)

    def test_by_the_same_bodies_under_other_names_is_accepted(
        self, measured: Robustness, written: Path
    ) -> None:
        moved = [attrs.evolve(body, label=f"moved/{body.label}") for body in measured.setting.bodies]
        refuse_another(written, attrs.evolve(measured.setting, bodies=tuple(moved)))
        with pytest.raises(InputError, match=r"bodies\.1: '.* in group 1'.*'.* in group 1'"):
            refuse_another(written, attrs.evolve(measured.setting, bodies=tuple(reversed(moved))))

    def test_by_a_damaged_measurement_is_refused_unless_forced(
        self, measured: Robustness, written: Path
    ) -> None:
        (written / "robustness.json").write_text("{")
        with pytest.raises(InputError, match="JSON") as caught:
            refuse_another(written, measured.setting)
        assert str(caught.value).startswith(f"{written / files.SETTING_FILE}: ")
        refuse_another(written, measured.setting, force=True)

    def test_by_something_else_is_refused_always(self, measured: Robustness, tmp_path: Path) -> None:
        (tmp_path / "letter.txt").write_text("Dear")
        for force in (False, True):
            with pytest.raises(InputError, match="not empty") as caught:
                refuse_another(tmp_path, measured.setting, force=force)
            assert caught.value.source == str(tmp_path)
            assert files.SETTING_FILE in caught.value.problem


class TestDamage:
    def test_of_a_missing_measurement_is_refused(self, tmp_path: Path) -> None:
        with pytest.raises(InputError, match=r"robustness\.json") as caught:
            read_robustness(tmp_path)
        assert caught.value.source == str(tmp_path)

    def test_of_scores_that_belong_to_another_setting_is_refused(self, written: Path) -> None:
        path = written / "scores.csv"
        first, second, *others = path.read_text().splitlines()
        path.write_text("\n".join([first, second.replace(",", ",1", 1), *others]) + "\n")
        with pytest.raises(InputError, match=r"SHA-256.*robustness\.json") as caught:
            read_robustness(written)
        assert caught.value.source == str(path)

    @pytest.mark.parametrize(
        ("damage", "data"),
        [
            (lambda d: [d], "robustness.json: not a measurement"),
            (lambda d: {**d, "format": 2}, "format: expected 1, found 2"),
            (lambda d: {**d, "format": True}, "format: expected 1, found True"),
            (lambda d: {**d, "seed": "1"}, ': seed: .*found "1"'),
            (lambda d: {**d, "seed": True}, ": seed: .*found true"),
            (lambda d: {**d, "controllers": 0}, ": controllers: .*>= 1.*found 0"),
            (lambda d: {**d, "controllers": 10**9}, "scores.csv: .* 1000000000 controllers"),
            (lambda d: {**d, "unit": 3}, ": unit: .*found 3"),
            (lambda d: {**d, "simulation": []}, r": simulation: .*found \[\]"),
            (lambda d: {**d, "bodies": []}, ": bodies: .*one or more"),
            (lambda d: {**d, "bodies": 3}, ": bodies: .*found 3"),
            (lambda d: {**d, "bodies": [{**d["bodies"][0], "label": []}]}, r": bodies\[0\]\.label: .*found"),
            (lambda d: {**d, "bodies": [d["bodies"][0]] * 3, "diverged": []}, ": bodies: .*different labels"),
            (lambda d: {**d, "more": 1}, ": more: "),
            (
                lambda d: {**d, "diverged": [{**d["diverged"][0], "step": -1}]},
                r": diverged\[0\]\.step: .*>= 0",
            ),
            (lambda d: {**d, "diverged": [{**d["diverged"][0], "body": "Z"}]}, ": diverged: .*'Z'"),
            (lambda d: {**d, "diverged": []}, r"scores\.csv: .*robustness\.json"),
        ],
    )
    def test_of_the_setting_is_refused(self, written: Path, damage: Callable[[Any], Any], data: str) -> None:
        path = written / "robustness.json"
        path.write_text(json.dumps(damage(json.loads(path.read_text()))))
        with pytest.raises(InputError, match=data):
            read_robustness(written)

    @pytest.mark.parametrize(
        ("damage", "data"),
        [
            (lambda lines: [], "columns"),
            (lambda lines: lines[1:], "columns"),
            (lambda lines: lines[:-1], "20 controllers"),
            (lambda lines: [lines[0], lines[2], lines[1], *lines[3:]], "20 controllers"),
            (lambda lines: [lines[0], "", *lines[1:]], "20 controllers"),
            (lambda lines: [*lines[:-1], f"{lines[-1]},1.0"], "controller 19: expected 3 scores, found 4"),
            (lambda lines: [*lines[:-1], "19,1.0,nan,1.0"], "controller 19: .*found nan"),
            (lambda lines: [*lines[:-1], "19,1.0,much,1.0"], "'much'"),
        ],
    )
    def test_of_the_scores_is_refused(
        self, written: Path, damage: Callable[[list[str]], list[str]], data: str
    ) -> None:
        path = written / "scores.csv"
        path.write_text("\n".join(damage(path.read_text().splitlines())))
        with pytest.raises(InputError, match=data) as caught:
            read_robustness(written)
        assert caught.value.source == str(path)


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig"])
def test_a_measurement_that_a_windows_program_saved_is_read(
    written: Path, measured: Robustness, end: str, encoding: str
) -> None:
    for name in (files.SCORES_FILE, files.SETTING_FILE):
        text = (written / name).read_bytes().decode()
        (written / name).write_bytes(text.replace("\n", end).encode(encoding))
    assert_same(read_robustness(written), measured)


@pytest.mark.parametrize("name", [files.SCORES_FILE, files.SETTING_FILE])
def test_a_measurement_in_another_encoding_is_refused(written: Path, name: str) -> None:
    (written / name).write_text((written / name).read_text(), encoding="utf-16")
    with pytest.raises(InputError, match="UTF-16") as caught:
        read_robustness(written)
    assert caught.value.source == str(written / name)
