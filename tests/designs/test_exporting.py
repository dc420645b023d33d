"""A design in all formats of its simulator; what a format cannot say is no file, and said in the log."""

from __future__ import annotations

import logging
from pathlib import Path

import numpy as np
import pytest
import toys

from evoframe import Design, Export, InputError
from evoframe.designs import export_all

PAIR = Design({"a": np.array([3.0]), "b": np.array([-2.0])})


def test_a_simulator_without_formats_gives_no_files() -> None:
    assert export_all(toys.Product(), PAIR) == {}


def test_every_format_gives_the_file_that_its_simulator_reads(tmp_path: Path) -> None:
    files = export_all(toys.Varied(gain=2.0), PAIR)
    assert files.keys() == {"toy", "txt"}
    assert files["toy"] is not None
    (tmp_path / "champion.toy").write_bytes(files["toy"])
    [(_, design)] = toys.Varied().read(tmp_path / "champion.toy")
    assert {role: array.tolist() for role, array in design.roles.items()} == {"a": [3.0], "b": [-2.0]}


def test_the_same_design_gives_the_same_bytes() -> None:
    assert export_all(toys.Varied(), PAIR) == export_all(toys.Varied(), Design(PAIR.roles))


@pytest.mark.parametrize(
    ("error", "words"),
    [(InputError("has no words"), "has no words"), (ZeroDivisionError("oops"), "ZeroDivisionError: oops")],
)
def test_one_that_fails_is_no_file_and_the_others_are(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture, error: Exception, words: str
) -> None:
    export = toys.Varied.export

    def fails(self: toys.Varied, design: Design, format_: str) -> Export:
        if format_ == "txt":
            raise error
        return export(self, design, format_)

    monkeypatch.setattr(toys.Varied, "export", fails)
    files = export_all(toys.Varied(), PAIR)
    assert files["txt"] is None
    assert files["toy"] is not None
    assert f"there is no txt file of the champion: {words}" in caplog.text


def test_what_a_format_leaves_out_is_said(caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level(logging.INFO)
    export_all(toys.Varied(gain=2.0), PAIR)
    assert [record.getMessage() for record in caplog.records] == [
        "the txt file of the champion leaves out: gain",
        "the txt file of the champion leaves out: limit",
    ]
