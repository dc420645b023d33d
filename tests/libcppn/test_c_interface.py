"""Parts of the C interface that Python does not use: missing arrays, sizes, statuses, and a C program."""

import math
import re
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, strategies as st
from symbols import ROOT, sources_of

import evoframe_libcppn
from evoframe_libcppn._cppn import ffi, lib

NODE = (0, lib.CPPN_SIN, 0.0, 1.0)
LINK = (-1, 0, 1.0)


def nodes_of(*rows: Any) -> Any:
    return ffi.new("struct cppn_node[]", rows)


def links_of(*rows: Any) -> Any:
    return ffi.new("struct cppn_link[]", rows)


def compiled(status: int, nodes: Any = (NODE,), links: Any = (LINK,)) -> int:
    """Compile a network with one input and output and check the status; return the culprit."""
    made, culprit = ffi.new("cppn_network **"), ffi.new("int64_t *", 77)
    returned = lib.cppn_compile(
        1, 1, len(nodes), nodes_of(*nodes), len(links), links_of(*links), made, culprit
    )
    assert returned == status
    assert (made[0] == ffi.NULL) == (status != lib.CPPN_OK)
    lib.cppn_destroy(made[0])
    found: int = culprit[0]
    return found


@pytest.fixture
def network() -> Any:
    made = ffi.new("cppn_network **")
    assert lib.cppn_compile(1, 1, 1, nodes_of(NODE), 1, links_of(LINK), made, ffi.NULL) == lib.CPPN_OK
    return ffi.gc(made[0], lib.cppn_destroy)


def test_every_status_has_a_message() -> None:
    statuses = ffi.typeof("enum cppn_status").elements
    messages = [ffi.string(lib.cppn_status_message(status)).decode() for status in statuses]
    assert len(set(messages)) == len(statuses)
    assert "unknown status" not in messages
    assert ffi.string(lib.cppn_status_message(12345)) == b"unknown status"


def test_the_culprit_is_the_invalid_item() -> None:
    other, late = (3, lib.CPPN_ABS, 0.0, 1.0), (-1, 3, 1.0)
    assert compiled(lib.CPPN_OK) == -1
    assert compiled(lib.CPPN_OK, links=()) == -1
    assert compiled(lib.CPPN_BAD_NODE_ID, nodes=(NODE, (-1, 0, 0.0, 1.0))) == 1
    assert compiled(lib.CPPN_REPEATED_NODE, nodes=(other, NODE, other)) in {0, 2}
    assert compiled(lib.CPPN_UNKNOWN_ACTIVATION, nodes=(NODE, (1, 23, 0.0, 1.0))) == 1
    assert compiled(lib.CPPN_UNKNOWN_ACTIVATION, nodes=((0, -1, 0.0, 1.0),)) == 0
    assert compiled(lib.CPPN_UNKNOWN_END, links=(LINK, late)) == 1
    assert compiled(lib.CPPN_MISSING_OUTPUT, nodes=(other,), links=(late,)) == 0
    assert compiled(lib.CPPN_MISSING_OUTPUT, nodes=(), links=()) == 0
    assert compiled(lib.CPPN_CYCLE, nodes=(other, NODE), links=((3, 0, 1.0), (3, 3, 1.0))) == 0


ROWS = st.tuples(st.integers(-1, 4), st.integers(-1, 23), st.floats(), st.floats())
ENDS = st.tuples(st.integers(-4, 5), st.integers(-1, 5), st.floats())


@given(st.lists(ROWS, max_size=6), st.lists(ENDS, max_size=12))
def test_any_arrays_return_finite_values_or_a_status(rows: Any, ends: Any) -> None:
    made, culprit = ffi.new("cppn_network **"), ffi.new("int64_t *")
    arrays = (len(rows), nodes_of(*rows), len(ends), links_of(*ends))
    status = lib.cppn_compile(3, 2, *arrays, made, culprit)
    if status == lib.CPPN_OK:
        outputs = ffi.new("double[4]", [math.nan] * 4)
        assert lib.cppn_evaluate(made[0], 2, ffi.new("double[6]", [0.5] * 6), outputs) == lib.CPPN_OK
        assert all(map(math.isfinite, outputs))
        assert 0 <= lib.cppn_evaluated_nodes(made[0]) <= len(rows)
    else:
        assert made[0] == ffi.NULL
        assert culprit[0] >= 0
    lib.cppn_destroy(made[0])


def test_missing_arguments_of_a_network() -> None:
    made, null = ffi.new("cppn_network **"), ffi.NULL
    nodes, links = nodes_of(NODE), links_of(LINK)
    assert lib.cppn_compile(1, 1, 1, null, 1, links, made, null) == lib.CPPN_NULL_ARGUMENT
    assert lib.cppn_compile(1, 1, 1, nodes, 1, null, made, null) == lib.CPPN_NULL_ARGUMENT
    assert lib.cppn_compile(1, 1, 1, nodes, 1, links, null, null) == lib.CPPN_NULL_ARGUMENT
    assert made[0] == null
    assert lib.cppn_compile(1, 1, 0, null, 0, null, made, null) == lib.CPPN_MISSING_OUTPUT
    assert lib.cppn_evaluated_nodes(null) == 0
    lib.cppn_destroy(null)


@pytest.mark.parametrize("size", [-1, -(2**63), 2**20 + 1, 2**62, 2**63 - 1])
def test_sizes_of_a_network_do_not_overflow(size: int) -> None:
    made, nodes, links = ffi.new("cppn_network **"), nodes_of(NODE), links_of(LINK)
    for index, status in (
        (0, lib.CPPN_BAD_INPUTS),
        (1, lib.CPPN_BAD_OUTPUTS),
        (2, lib.CPPN_BAD_NODES),
        (4, lib.CPPN_BAD_LINKS),
    ):
        arguments = [1, 1, 1, nodes, 1, links, made, ffi.NULL]
        arguments[index] = size
        assert lib.cppn_compile(*arguments) == status
        assert made[0] == ffi.NULL


def test_missing_arguments_of_an_evaluation(network: Any) -> None:
    arguments = [network, 1, ffi.new("double[1]"), ffi.new("double[1]")]
    assert lib.cppn_evaluate(*arguments) == lib.CPPN_OK
    for i in (0, 2, 3):
        assert lib.cppn_evaluate(*arguments[:i], ffi.NULL, *arguments[i + 1 :]) == lib.CPPN_NULL_ARGUMENT


@pytest.mark.parametrize("n", [-1, -(2**63), 2**60, 2**63 - 1])
def test_numbers_of_points_do_not_overflow(network: Any, n: int) -> None:
    outputs = ffi.new("double[1]", [7.0])
    assert lib.cppn_evaluate(network, n, ffi.new("double[1]"), outputs) == lib.CPPN_BAD_POINTS
    assert outputs[0] == 7.0


def test_the_version_agrees_with_the_header() -> None:
    header = (ROOT / "libcppn" / "include" / "cppn.h").read_text(encoding="utf-8")
    [version] = re.findall(r'^#define CPPN_VERSION "(\d+\.\d+\.\d+)"$', header, re.MULTILINE)
    assert version == evoframe_libcppn.VERSION


def test_a_c_program_runs(tmp_path: Path) -> None:
    compiler = shutil.which("cc")
    assert compiler, "this test requires the C compiler cc, like the installation"
    sources = map(str, sources_of("libcppn"))
    program = str(tmp_path / "embed")
    include = ["-I", str(ROOT / "libcppn" / "include"), "-I", str(ROOT / "libcppn")]
    embed = str(ROOT / "tests" / "libcppn" / "embed.c")
    subprocess.run([compiler, "-std=c11", "-O1", *include, embed, *sources, "-o", program, "-lm"], check=True)
    output = subprocess.run([program], check=True, capture_output=True, text=True).stdout
    wave = [math.sin(5.0 * x) for x in (0.5, 1.0, 0.0)]
    distances = [0.0, 0.5, math.sqrt(0.5)]
    rows = zip(distances, wave, strict=True)
    assert output.splitlines() == [f"{distance:.9f} {height:.9f}" for distance, height in rows]
