"""Values nested deeper than any real one: refused with a message before a function recurses into them."""

from __future__ import annotations

import json
import shutil
import sys
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import toys
from click.testing import CliRunner
from recorded import rewritten, rows

from evoframe import ConfigurationError, load_config, measure_robustness, run
from evoframe.cli import cli
from evoframe.errors import ComponentError
from evoframe.evolution.assembly import assemble
from evoframe.files.reading import DEEPEST
from evoframe.robustness.files import write_measurement

DEPTHS = [DEEPEST - 8, 900, 100_000]

STUDY = 'extends = "quick"\nruns = 1\n[run]\ngenerations = 1\n[grid]\naggregator = ["am"]\n'


@pytest.fixture(scope="module")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a run, its measurement of robustness, its report, and a study."""
    folder = tmp_path_factory.mktemp("recorded")
    run(load_config("quick", overrides=["run.generations=1"]), out=folder / "run")
    (folder / "run" / "robustness").mkdir()
    write_measurement(measure_robustness(folder / "run", controllers=1), folder / "run" / "robustness")
    (folder / "run" / "report").mkdir()
    (folder / "run" / "report" / "report.json").write_text('{"files": {}}')
    (folder / "study.toml").write_text(STUDY)
    made = CliRunner().invoke(
        cli, ["study", str(folder / "study.toml"), "-q", "--out", str(folder / "study")]
    )
    assert made.exit_code == 0, made.output
    return folder


@pytest.fixture
def folder(recorded: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(shutil.copytree(recorded, tmp_path / "here"))
    return Path()


def nested(depth: int) -> str:
    """Return lists inside lists, which are JSON and TOML."""
    return "[" * depth + "]" * depth


def nested_tables(depth: int) -> str:
    """Return tables inside tables, as JSON."""
    return '{"a":' * depth + "1" + "}" * depth


def ended(depth: int, *arguments: object) -> str:
    """Run a command, which must refuse what is deeper than the limit; return its output."""
    result = CliRunner().invoke(cli, [*map(str, arguments)])
    assert isinstance(result.exception, SystemExit | None), repr(result.exception)
    assert result.exit_code == 2 or depth <= DEEPEST, result.output
    return result.output


def replaced(path: Path, keys: tuple[str, ...], text: str) -> None:
    """Replace the value at *keys* of a JSON file by a text."""
    tree = json.loads(path.read_text())
    inner = tree
    for key in keys[:-1]:
        inner = inner[key]
    inner[keys[-1]] = "REPLACED"
    path.write_text(json.dumps(tree).replace('"REPLACED"', text))


CHAMPION = [
    *[
        ("format",),
        ("score",),
        ("simulation",),
        ("simulation", "simulator"),
        ("simulation", "simulator", "x"),
    ],
    *[
        ("simulation", "objective"),
        ("simulation", "objective", "name"),
        ("design",),
        ("design", "morphology"),
    ],
    *[("design", "morphology", key) for key in ("dtype", "shape", "values")],
]


@pytest.mark.parametrize("nest", [nested, nested_tables])
@pytest.mark.parametrize("depth", DEPTHS)
@pytest.mark.parametrize("keys", CHAMPION, ids=".".join)
def test_a_champion_is_refused(
    folder: Path, keys: tuple[str, ...], depth: int, nest: Callable[[int], str]
) -> None:
    path = folder / "run" / "champion.json"
    replaced(path, keys, nest(depth))
    output = ended(depth, "simulate", path)
    assert str(path) in output
    assert (f"more than {DEEPEST} deep" in output) == (depth > DEEPEST)


@pytest.mark.parametrize("depth", DEPTHS)
@pytest.mark.parametrize(
    ("name", "keys", "command"),
    [
        ("run/verification.json", ("score",), ["report", "run"]),
        ("run/verification.json", ("rows",), ["report", "run"]),
        ("run/robustness/robustness.json", ("bodies",), ["robustness", "run", "--controllers", "1"]),
        ("run/robustness/robustness.json", ("seed",), ["robustness", "run", "--controllers", "1"]),
        ("run/robustness/robustness.json", ("simulation",), ["report", "run"]),
        ("run/report/report.json", ("files",), ["report", "run"]),
    ],
)
def test_other_documents_are_refused(
    folder: Path, name: str, keys: tuple[str, ...], command: list[str], depth: int
) -> None:
    replaced(folder / name, keys, nested(depth))
    assert name in ended(depth, *command)


@pytest.mark.parametrize("depth", DEPTHS)
def test_the_cause_of_a_failure_is_shown_or_unknown(folder: Path, depth: int) -> None:
    [directory] = (path.parent for path in (folder / "study").rglob("run.db"))
    shutil.rmtree(directory)
    directory.mkdir()
    (directory / "failure.json").write_text(f'{{"cause": {nested(depth)}}}')
    result = CliRunner().invoke(cli, ["study", "study", "--dry-run"])
    assert result.exit_code == 0, result.output
    assert "1 run failed" in result.output


TABLES = [("meta", "value", "key"), ("state", "state", "part"), ("best_pairs", "document", "turn")]


@pytest.mark.parametrize("depth", DEPTHS)
@pytest.mark.parametrize(("table", "column", "key"), TABLES)
@pytest.mark.parametrize("command", ["resume", "doctor", "simulate"])
def test_a_database_is_refused_or_not_read(
    folder: Path, table: str, column: str, key: str, command: str, depth: int
) -> None:
    directory = folder / "run"
    rewritten(directory, f"UPDATE {table} SET {column} = ? WHERE {key} != 'format'", nested(depth))  # noqa: S608
    result = CliRunner().invoke(cli, [command, str(directory)])
    assert isinstance(result.exception, SystemExit | None), repr(result.exception)
    assert result.exit_code in (1, 2) or table != "best_pairs"  # the others are not needed by each command


@pytest.mark.parametrize("depth", DEPTHS)
@pytest.mark.parametrize(
    "text",
    [
        "x = {}",
        "[grid.x]\ny = {}",
        "[aggregator]\nweights = {}",
        "[simulator]\nname = {}",
        "[plugins]\nblock = {}",
    ],
)
@pytest.mark.parametrize("command", [["run"], ["config", "show"], ["study", "--dry-run"]])
def test_toml_is_refused(folder: Path, command: list[str], text: str, depth: int) -> None:
    (folder / "deep.toml").write_text(f"{STUDY}{text.format(nested(depth))}")
    assert "deep" in ended(depth, *command, "deep.toml")
    (folder / "extending.toml").write_text(STUDY.replace("quick", "deep.toml"))
    ended(depth, *command, "extending.toml")


@pytest.mark.parametrize("depth", DEPTHS)
def test_tables_inside_tables_are_refused(folder: Path, depth: int) -> None:
    inline = "{a=" * depth + "1" + "}" * depth
    (folder / "deep.toml").write_text(f"x = {inline}\n")
    ended(depth, "config", "show", "deep.toml")
    dotted = ".".join(["a"] * depth)
    for text in (f"{dotted} = 1", f"[{dotted}]", f"[[{dotted}]]"):
        (folder / "deep.toml").write_text(f"{text}\n")
        ended(depth, "config", "show", "deep.toml")
    ended(depth, "config", "show", "--set", f"x={inline}")
    ended(depth, "config", "show", "--set", f"{dotted}=1")


@pytest.mark.parametrize("depth", DEPTHS)
@pytest.mark.parametrize("name", ["run/config.toml", "study/study.toml"])
def test_configurations_that_evoframe_wrote_are_refused(folder: Path, name: str, depth: int) -> None:
    path = folder / name
    path.write_text(f"x = {nested(depth)}\n{path.read_text()}")
    directory = path.parent
    for command in (["resume"], ["report"], ["verify"], ["study", "--dry-run"]):
        if name.startswith("study") or command[0] != "study":
            ended(depth, *command, directory)


@pytest.mark.parametrize("depth", DEPTHS)
def test_values_of_a_grid_are_refused(folder: Path, depth: int) -> None:
    for grid in (f"{{aggregator=[{nested(depth)}]}}", f"{{aggregator={nested(depth)}}}"):
        ended(depth, "study", "study.toml", "--dry-run", "--set", f"grid={grid}")
        (folder / "deep.toml").write_text(STUDY.replace('["am"]', grid.partition("=")[2].removesuffix("}")))
        ended(depth, "study", "deep.toml", "--dry-run")


@pytest.mark.parametrize("depth", [*DEPTHS, 255])
def test_xml_is_refused(folder: Path, depth: int) -> None:
    for text in (
        "<VXA>" * depth + "</VXA>" * depth,
        f"<VXA><VXC>{'<Palette>' * depth}{'</Palette>' * depth}</VXC></VXA>",
        f"<VXA><Simulator>{'<a><b/>' * depth}{'</a>' * depth}</Simulator></VXA>",
    ):
        (folder / "deep.vxa").write_text(text)
        assert "deep.vxa" in ended(depth, "simulate", "deep.vxa")


@pytest.mark.parametrize("depth", DEPTHS)
def test_the_header_of_an_array_is_refused(folder: Path, depth: int) -> None:
    shape = "(" * depth + ")" * depth
    header = f"{{'descr': '|u1', 'fortran_order': False, 'shape': {shape}, }}\n".encode()
    with zipfile.ZipFile("deep.npz", "w") as archive:
        for name in ("material", "phase_cycles"):
            size = min(len(header), 2**16 - 1)
            archive.writestr(f"{name}.npy", b"\x93NUMPY\x01\x00" + size.to_bytes(2, "little") + header[:size])
    assert "deep.npz" in ended(depth, "simulate", "deep.npz")


def test_values_from_python_are_refused() -> None:
    deep: Any = 1
    for _ in range(DEEPEST + 1):
        deep = [deep]
    cyclic: list[Any] = []
    cyclic.append(cyclic)
    for value in (deep, cyclic):
        with pytest.raises(ConfigurationError, match="deep"):
            run("quick", aggregator={"weights": value})


def test_a_genome_too_deep_to_be_read_back_is_the_fault_of_its_evolver(
    toy_config: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    def dump(_: object, genome: Any) -> Any:
        for _ in range(DEEPEST):
            genome = [genome]
        return genome

    monkeypatch.setattr(toys.DriftRun, "dump", dump)
    with assemble(toy_config()) as coevolution, pytest.raises(ComponentError, match="deep") as caught:
        list(coevolution)
    assert caught.value.component == "populations.a.evolver"


def test_the_limit_is_far_from_that_of_python_and_from_real_documents(recorded: Path) -> None:
    assert sys.getrecursionlimit() > 10 * DEEPEST
    texts = [path.read_text() for path in recorded.rglob("*.json")]
    for table, column in (("meta", 1), ("state", 2), ("best_pairs", 2)):
        texts += [row[column] for row in rows(recorded / "run", table)]
    assert len(texts) > 8
    assert 2 <= max(map(depth_of, map(json.loads, texts))) <= DEEPEST / 8


def depth_of(document: Any) -> int:
    items = document.values() if isinstance(document, dict) else document
    return 1 + max(map(depth_of, items), default=0) if isinstance(document, dict | list) else 0
