"""``python -m benchmarks`` runs; the measured times are not tested."""

import json
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from processes import python

from benchmarks.__main__ import SECTIONS

ROOT = Path(__file__).parent.parent.parent


def figures(values: Any, path: str = "") -> Iterator[tuple[str, float]]:
    """Yield all numbers of a document, each with its path."""
    if isinstance(values, dict):
        for key, value in values.items():
            yield from figures(value, f"{path}/{key}")
    elif isinstance(values, list):
        for index, value in enumerate(values):
            yield from figures(value, f"{path}/{index}")
    elif isinstance(values, float | int) and not isinstance(values, bool):
        yield path, values


@pytest.fixture(scope="module")
def quick(tmp_path_factory: pytest.TempPathFactory) -> tuple[str, dict[str, Any]]:
    """The printed output and the JSON document of a quick run of all sections."""
    file = tmp_path_factory.mktemp("benchmarks") / "figures.json"
    finished = python("-m", "benchmarks", "--quick", "--json", file, directory=ROOT)
    assert finished.returncode == 0, finished.stdout + finished.stderr
    return finished.stdout, json.loads(file.read_text(encoding="utf-8"))


def test_every_section_is_printed(quick: tuple[str, dict[str, Any]]) -> None:
    printed, _ = quick
    assert [name for name in SECTIONS if f"\n{name}: " not in printed] == []


def test_every_section_is_in_the_document(quick: tuple[str, dict[str, Any]]) -> None:
    _, document = quick
    assert list(document["sections"]) == list(SECTIONS)
    assert document["failed"] == {}
    assert all(section["tables"] for section in document["sections"].values())


def test_the_machine_is_described(quick: tuple[str, dict[str, Any]]) -> None:
    printed, document = quick
    for about in ("processor", "kernels", "compiler", "flags of libvox", "python", "load at the start"):
        assert document["machine"][about]
        assert f"{about}:" in printed


def test_figures_are_finite_and_positive(quick: tuple[str, dict[str, Any]]) -> None:
    """Exceptions: a share of contacts is a difference of two times, and a count may be 0."""
    _, document = quick
    found = dict(figures(document["sections"]))
    counts = ("divide", "square root")
    free = {path for path in found if "share of contacts" in path or path.endswith(counts)}
    assert len(found) > 100
    assert [path for path, value in found.items() if not math.isfinite(value)] == []
    assert [path for path in found.keys() - free if found[path] <= 0.0] == []


def test_sections_can_be_selected(tmp_path: Path) -> None:
    file = tmp_path / "figures.json"
    finished = python(
        "-m",
        "benchmarks",
        "--quick",
        "--only",
        "networks",
        "--only",
        "evolution",
        "--json",
        file,
        directory=ROOT,
    )
    assert finished.returncode == 0, finished.stderr
    assert list(json.loads(file.read_text(encoding="utf-8"))["sections"]) == ["networks", "evolution"]


def test_without_a_compiler_the_roofline_fails_by_name(tmp_path: Path) -> None:
    file = tmp_path / "figures.json"
    command = ("-m", "benchmarks", "--quick", "--only", "roofline", "--json", file)
    finished = python(*command, directory=ROOT, CC="no-such-compiler")
    assert finished.returncode == 1
    assert "roofline failed" in finished.stdout
    assert "'no-such-compiler'" in finished.stdout
    assert list(json.loads(file.read_text(encoding="utf-8"))["failed"]) == ["roofline"]
