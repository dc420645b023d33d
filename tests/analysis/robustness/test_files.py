"""Tests of the files of findings, and of their JSON."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import pandas as pd
import pytest
from measuring import measure

from evoframe import InputError
from evoframe.analysis.robustness import as_json, conclusions, find, records, write_findings, write_robustness


def test_findings_do_not_touch_the_scores(tmp_path: Path) -> None:
    found = find(measure([1.0, 2.0], 10))
    everything = write_robustness(found, tmp_path / "r")
    scores = (tmp_path / "r" / "scores.csv").read_bytes()
    again = write_findings(found, tmp_path / "r")
    assert {*everything} - {*again} == {tmp_path / "r" / name for name in ("scores.csv", "robustness.json")}
    assert (tmp_path / "r" / "scores.csv").read_bytes() == scores
    assert (tmp_path / "r" / "conclusions.txt").read_text() == conclusions(found)


def test_tables_in_json_are_those_of_the_files(tmp_path: Path) -> None:
    found = find(measure([1.0, 2.0, 3.0], 20, groups="XXY", most=1.5))
    write_robustness(found, tmp_path / "r")
    document = json.loads(json.dumps(as_json(found), allow_nan=False))
    for name, rows in document["tables"].items():
        with (tmp_path / "r" / f"{name}.csv").open() as file:
            lines = list(csv.DictReader(file))
        assert [[*row] for row in lines] == [[*row] for row in rows]
        for line, row in zip(lines, rows, strict=True):
            for key, value in row.items():
                assert line[key] == ("" if value is None else str(value))


def test_files_are_in_millimeters_and_json_in_meters(tmp_path: Path) -> None:
    found = find(measure([1.0, 2.0, 3.0], 20, unit="m"))
    write_robustness(found, tmp_path / "r")
    for name, rows in as_json(found)["tables"].items():
        table = pd.read_csv(tmp_path / "r" / f"{name}.csv")
        assert len(table) == len(rows)
        if name in ("groups", "bodies"):
            for key in ("median", "first quartile", "third quartile", "least", "greatest"):
                assert list(table[f"{key} (mm)"]) == pytest.approx([1000 * row[key] for row in rows])
            assert "median (mm)" in (tmp_path / "r" / f"{name}.tex").read_text()


def test_missing_values_are_none() -> None:
    table = pd.DataFrame({"a": [1.5, float("nan")], "b": ["x", None]})
    assert records(table) == [{"a": 1.5, "b": "x"}, {"a": None, "b": None}]


def test_only_a_measurement_of_the_same_setting_is_overwritten_unasked(tmp_path: Path) -> None:
    found = find(measure([1.0, 2.0], 10))
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "groups.csv").write_text("mine")
    with pytest.raises(InputError) as caught:
        write_robustness(found, tmp_path / "mine")
    assert caught.value.source == str(tmp_path / "mine")
    assert [path.read_text() for path in (tmp_path / "mine").iterdir()] == ["mine"]
    for _ in range(2):
        write_robustness(found, tmp_path / "r")
    before = (tmp_path / "r" / "scores.csv").read_bytes()
    other = find(measure([1.0, 2.0], 11))
    with pytest.raises(InputError):
        write_robustness(other, tmp_path / "r")
    assert (tmp_path / "r" / "scores.csv").read_bytes() == before
    write_robustness(other, tmp_path / "r", force=True)
    assert (tmp_path / "r" / "scores.csv").read_bytes() != before
