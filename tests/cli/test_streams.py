"""Commands whose streams are closed, full, missing or cannot encode, and plugins that print."""

from __future__ import annotations

import ast
import errno
import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Mapping
from pathlib import Path

import attrs
import broken_streams
import pytest
import toys
from processes import Evoframe, python, surroundings

from evoframe import cli, load_run

linux = pytest.mark.skipif(sys.platform != "linux", reason="needs /dev/full and names of any bytes")

RUN = "rün \udcff"
"""A name outside of ASCII, with a byte that is not UTF-8."""

SMALL = ["--set", "run.generations=1", "--workers", "1"]

COMMANDS: Mapping[str, list[str]] = {
    "help": ["--help"],
    "version": ["--version"],
    "unknown": ["rünn"],
    "missing": ["simulate", "nöwhere"],
    "run": ["run", "quick", "--out", "nëw \udcff", *SMALL],
    "run -q": ["run", "quick", "-q", "--out", "nëw \udcff", *SMALL],
    "run -vv": ["run", "quick", "-vv", "--out", "nëw \udcff", *SMALL],
    "run processes": ["run", "quick", "--out", "nëw \udcff", *SMALL, "--set", "executor=processes"],
    "resume": ["resume", RUN],
    "resume --verify": ["resume", f"{RUN} unverified"],
    "simulate": ["simulate", RUN],
    "simulate --json": ["simulate", RUN, "--json"],
    "simulate --trace": ["simulate", RUN, "--trace", "träce.csv"],
    "verify": ["verify", RUN],
    "verify --json": ["verify", RUN, "--json"],
    "export": ["export", RUN, "--to", "vxa", "--out", "-"],
    "export to a file": ["export", RUN, "--to", "vxa", "--out", "nëw.vxa"],
    "doctor": ["doctor"],
    "doctor --json": ["doctor", RUN, "--json"],
    "config show": ["config", "show", "--comments"],
    "config new": ["config", "new", "nëw \udcff.toml"],
    "config new -": ["config", "new", "-"],
    "plugins list": ["plugins", "list"],
    "plugins list --json": ["plugins", "list", "--json"],
    "completion": ["completion", "bash"],
    "study": ["study", "stüdy.toml", "--out", "stüdy \udcff"],
    "study --dry-run": ["study", "stüdy.toml", "--dry-run"],
    "report": ["report", RUN],
    "robustness": ["robustness", RUN, "--controllers", "2"],
    "robustness --json": ["robustness", RUN, "--controllers", "2", "--json"],
}

EXIT_CODES = {"unknown": 2, "missing": 2}
SILENT = {"unknown", "missing", "resume", "config new"}
"""Commands that print nothing on standard output."""

STUDY = 'extends = "quick"\nruns = 1\n[run]\ngenerations = 1\n[grid]\naggregator = ["am", "hm"]\n'


@attrs.frozen
class Kind:
    """A kind of broken streams.

    Attributes:
        code: Exit code of a command whose output is lost.
        broken: Descriptor -> ``closed``, ``full`` or ``pipe``.
        environment: Changes to the environment.
        missing: Whether Python has no streams.
    """

    code: int = 0
    broken: Mapping[int, str] = attrs.field(factory=dict)
    environment: Mapping[str, str] = attrs.field(factory=dict)
    missing: bool = False


KINDS: Mapping[str, Kind] = {
    "intact": Kind(),
    "ascii": Kind(environment={"PYTHONIOENCODING": "ascii"}),
    "latin-1": Kind(environment={"PYTHONIOENCODING": "latin-1"}),
    "C locale": Kind(environment={"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}),
    **{
        f"{kind} {name}": Kind(0 if name == "stderr" else code, dict.fromkeys(descriptors, kind))
        for kind, code in (("closed", 1), ("full", 1), ("pipe", 141))
        for name, descriptors in (("stdout", [1]), ("stderr", [2]), ("both", [1, 2]))
    },
    "closed all": Kind(1, dict.fromkeys([0, 1, 2], "closed")),
    "missing": Kind(1, missing=True),
}


@pytest.fixture(scope="module")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A directory with a verified run, an unverified run, and a study to start."""
    directory = tmp_path_factory.mktemp("recorded")
    made = python("-m", "evoframe", "run", "quick", "-q", "--out", RUN, *SMALL, directory=directory)
    assert made.returncode == 0, made.stderr
    shutil.copytree(directory / RUN, directory / f"{RUN} unverified")
    (directory / f"{RUN} unverified" / "verification.json").unlink()
    (directory / "stüdy.toml").write_text(STUDY, encoding="utf-8")
    return directory


def breaking(kind: Kind) -> Callable[[], None]:
    """Return the function that breaks the streams of a process before Python starts in it."""

    def break_streams() -> None:
        for descriptor, how in kind.broken.items():
            if how == "closed":
                os.close(descriptor)
            elif how == "full":
                os.dup2(os.open("/dev/full", os.O_WRONLY), descriptor)
            else:
                read, write = os.pipe()
                os.dup2(write, descriptor)
                os.close(read)
                os.close(write)

    return break_streams


@linux
@pytest.mark.parametrize("name", KINDS)
def test_no_command_ends_in_a_traceback(name: str, recorded: Path, tmp_path: Path) -> None:
    kind = KINDS[name]
    directories = {command: tmp_path / str(number) for number, command in enumerate(COMMANDS)}
    for directory in directories.values():
        shutil.copytree(recorded, directory)
    todo = json.dumps([[str(directories[command]), given] for command, given in COMMANDS.items()])
    streams = "missing" if kind.missing else "given"
    ended = subprocess.run(
        [sys.executable, broken_streams.__file__, str(tmp_path / "outcomes.json"), streams, todo],
        env={**surroundings(), **kind.environment},
        capture_output=True,
        preexec_fn=breaking(kind),
        check=True,
    )
    outcomes = dict(zip(COMMANDS, json.loads((tmp_path / "outcomes.json").read_text()), strict=True))
    expected = {
        command: EXIT_CODES.get(command, 0 if command in SILENT else kind.code) for command in COMMANDS
    }
    assert outcomes == expected, ended.stderr.decode(errors="replace")
    assert b"Traceback" not in ended.stderr
    assert b"Error ignored" not in ended.stderr
    if name == "ascii":
        assert (ended.stdout + ended.stderr).isascii()
    for command in ("run", "run -q", "run -vv", "run processes"):
        run = load_run(directories[command] / "nëw \udcff")
        assert run.finished()
        assert run.verification() is not None
    assert load_run(directories["resume --verify"] / f"{RUN} unverified").verification() is not None
    [study] = directories["study"].glob("st*dy \udcff")
    assert (study / "rows.csv").read_text().count("\n") == 3
    assert (directories["report"] / RUN / "report" / "report.html").is_file()
    assert (directories["robustness"] / RUN / "robustness" / "robustness.json").is_file()
    assert (directories["simulate --trace"] / "träce.csv").is_file()


@pytest.mark.parametrize("path", sorted(Path(cli.__path__[0]).glob("*.py")), ids=lambda path: path.name)
def test_commands_print_output_only_as_requested_output(path: Path) -> None:
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Call) and ast.unparse(node.func) in ("click.echo", "print"):
            assert {keyword.arg for keyword in node.keywords} & {"err", "file"}, ast.unparse(node)


def test_a_loss_of_the_output_is_reported_once(evoframe: Evoframe) -> None:
    with open("/dev/full", "w") as full:  # noqa: PTH123 - a device
        lost = subprocess.run(
            [sys.executable, "-m", "evoframe", "plugins", "list", "--json"],
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
        )
    assert lost.returncode == 1
    assert lost.stderr.count("\n") == 1
    assert os.strerror(errno.ENOSPC) in lost.stderr


@pytest.fixture
def loud_run(evoframe: Evoframe, tmp_path: Path, toy_file: Path) -> Evoframe:
    """The program with the loud plugin, and a run made with it."""
    support = str(Path(toys.__file__).parent)

    def loudly(*arguments: str, **environment: str) -> subprocess.CompletedProcess[str]:
        return evoframe("-p", "toys", "-p", "loud", *arguments, PYTHONPATH=support, **environment)

    made = loudly("-q", "run", toy_file.name, "--out", "run", "--set", "simulator=loud", LOUD="mildly")
    assert made.returncode == 0, made.stderr
    assert made.stdout == "run\n"
    return loudly


MEANS = ("print", "kept", "write", "buffer", "original", "descriptor", "libc", "child", "click")
PROCESSES = ["--set", "executor={name='processes', workers=2}"]


@linux
@pytest.mark.parametrize(
    ("arguments", "heard"),
    [
        (["simulate", "run", "--json"], "simulate"),
        (["simulate", "run", "--json", *PROCESSES], "simulate"),
        (["verify", "run", "--json"], "simulate"),
        (["verify", "run", "--json", *PROCESSES], "simulate"),
        (["robustness", "run", "--controllers", "2", "--json"], "simulate"),
        (["doctor", "run", "--json"], "simulate"),
        (["doctor", "--json"], "import"),
        (["plugins", "list", "--json"], "import"),
    ],
    ids=" ".join,
)
def test_text_of_plugins_never_lands_in_json(loud_run: Evoframe, arguments: list[str], heard: str) -> None:
    printed = loud_run(*arguments)
    assert printed.returncode == 0, printed.stderr
    json.loads(printed.stdout)
    lines = printed.stderr.splitlines()
    for means in MEANS:
        assert any(line.startswith(f"{means} {heard}") for line in lines), means


@linux
@pytest.mark.parametrize(
    "arguments",
    [
        ["config", "show", "toy.toml"],
        ["export", "run", "--to", "toy", "--out", "-"],
        ["study", "study.toml", "-q"],
        ["--version"],
        ["completion", "bash"],
    ],
    ids=" ".join,
)
def test_text_of_plugins_never_lands_in_other_output(
    loud_run: Evoframe, evoframe: Evoframe, tmp_path: Path, arguments: list[str]
) -> None:
    (tmp_path / "study.toml").write_text('extends="toy.toml"\nruns=1\n[grid]\nsimulator=["loud"]\n')
    printed = loud_run(*arguments)
    assert printed.returncode == 0, printed.stderr
    assert not [line for line in printed.stdout.splitlines() if line.startswith(MEANS)]
    assert printed.stdout


@linux
def test_a_worker_that_prints_to_a_broken_stream_is_not_lost(loud_run: Evoframe, tmp_path: Path) -> None:
    support = str(Path(toys.__file__).parent)
    command = [sys.executable, "-m", "evoframe", "-p", "toys", "-p", "loud", "simulate", "run", "--json"]
    with open("/dev/full", "w") as full:  # noqa: PTH123 - a device
        simulated = subprocess.run(
            [*command, *PROCESSES],
            stdout=subprocess.PIPE,
            stderr=full,
            cwd=tmp_path,
            env={**surroundings(), "PYTHONPATH": support, "PYTHONIOENCODING": "ascii", "LOUD": "mildly"},
            check=False,
        )
    assert simulated.returncode == 0
    json.loads(simulated.stdout)


def test_the_output_of_a_plugins_command_is_its_own(loud_run: Evoframe) -> None:
    lines = loud_run("greet", LOUD="mildly").stdout.splitlines()
    assert lines == ["hello", "from a child"]


@linux
@pytest.mark.parametrize("path", ["/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"])
def test_standard_output_can_be_named_as_a_file(evoframe: Evoframe, recorded: Path, path: str) -> None:
    exported = evoframe("export", recorded / RUN, "--to", "vxa", "--out", path)
    assert exported.stdout.startswith("<?xml")
    traced = evoframe("simulate", recorded / RUN, "--json", "--trace", path)
    header, *_, last = traced.stdout.splitlines()
    assert header.startswith("step,")
    assert json.loads(last)["labels"]
