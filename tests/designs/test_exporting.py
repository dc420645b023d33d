"""Export of a design in all formats; a format that cannot represent it gives no file but a log line."""

from __future__ import annotations

import logging
import re
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
def test_a_format_that_fails_does_not_affect_the_others(
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
    assert re.search(f"txt.*: {words}", caplog.text)


def test_omitted_settings_are_logged(caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level(logging.INFO)
    export_all(toys.Varied(gain=2.0), PAIR)
    assert [record.args for record in caplog.records] == [("txt", "gain"), ("txt", "limit")]
