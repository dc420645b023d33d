"""Measurement of a core's peak, by a small C extension built with the compiler of the solver."""

from __future__ import annotations

import importlib.util
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import attrs
import numpy as np
from cffi import FFI, VerificationError  # type: ignore[import-untyped]

from benchmarks.machine import compiler
from benchmarks.report import SectionError

__all__ = ["INSTRUCTIONS", "Peak", "bandwidth", "peak"]

INSTRUCTIONS = {
    "generic": (),
    "avx2": ("-mavx2",),
    "avx512": ("-mavx512f", "-mavx512dq", "-mavx512vl", "-mavx512bw", "-mprefer-vector-width=512"),
}
"""Flags of the compiler for each vector kernel, as in ``libvox/kernels/kernel_*.c``."""

_SOURCE = Path(__file__).with_name("peaks.c")
_FLAGS = ("-std=gnu11", "-O3", "-ffp-contract=off", "-fno-math-errno", "-fno-trapping-math")
_FUNCTIONS = """
int64_t chains_operations(void);
double chains_run(int64_t rounds, double factor, double term);
int64_t held_numbers(void);
double divisions_run(int64_t rounds, double dividend);
double roots_run(int64_t rounds, double term);
void triad_run(int64_t rounds, int64_t n, double factor, double *to, const double *a, const double *b);
"""
_TRIES = 5  # the best of them is the peak


@attrs.frozen
class Peak:
    """Peak rates of a core, per second.

    Attributes:
        operations: Multiplications and additions of doubles, half of each.
        divisions: Divisions of doubles.
        roots: Square roots of doubles, each with an addition.
    """

    operations: float
    divisions: float
    roots: float


def peak(kernel: str, seconds: float) -> Peak:
    """Measure the peak with the instructions of a kernel.

    Args:
        kernel: One of ``INSTRUCTIONS``.
        seconds: Approximate duration of each try, s.

    Raises:
        SectionError: The compiler is missing or fails.
    """
    lib, _ = _compiled(kernel)
    return Peak(
        lib.chains_operations() * _rate(lambda rounds: lib.chains_run(rounds, 0.999, 0.001), seconds),
        lib.held_numbers() * _rate(lambda rounds: lib.divisions_run(rounds, 3.0), seconds),
        lib.held_numbers() * _rate(lambda rounds: lib.roots_run(rounds, 0.5), seconds),
    )


def bandwidth(kernel: str, size: int, seconds: float) -> float:
    """Measure the bytes per second that a core reads and writes, two to one, in *size* bytes of memory.

    Raises:
        SectionError: The compiler is missing or fails.
    """
    lib, ffi = _compiled(kernel)
    n = size // 24
    arrays = [ffi.from_buffer("double[]", np.ones(n)) for _ in range(3)]
    return 24 * n * _rate(lambda rounds: lib.triad_run(rounds, n, 0.5, *arrays), seconds)


def _rate(run: Callable[[int], object], seconds: float) -> float:
    """Return the best rate of rounds per second of CPU time."""
    rounds = 1
    while (taken := _time(run, rounds)) < seconds:
        rounds = 2 * rounds if taken < seconds / 100 else int(1.1 * rounds * seconds / taken) + 1
    return max(rounds / _time(run, rounds) for _ in range(_TRIES))


def _time(run: Callable[[int], object], rounds: int) -> float:
    began = time.thread_time()
    run(rounds)
    return time.thread_time() - began


_modules: dict[str, Any] = {}


def _compiled(kernel: str) -> tuple[Any, Any]:
    """Return the functions compiled for the instructions of a kernel."""
    if kernel not in _modules:
        _modules[kernel] = _compile(kernel)
    return _modules[kernel].lib, _modules[kernel].ffi


def _compile(kernel: str) -> Any:
    ffi, name = FFI(), f"_peaks_{kernel}"
    ffi.cdef(_FUNCTIONS)
    flags = [*_FLAGS, *INSTRUCTIONS[kernel]]
    source = _SOURCE.read_text(encoding="utf-8")
    ffi.set_source(name, source, extra_compile_args=flags, libraries=["m"])
    with tempfile.TemporaryDirectory() as directory:
        try:
            return _imported(name, Path(ffi.compile(tmpdir=directory)))
        except VerificationError as error:
            command = " ".join(compiler())
            raise SectionError(
                f"cannot measure the peak of a core: '{command}' does not compile {_SOURCE.name}: {error}"
            ) from error


def _imported(name: str, path: Path) -> Any:
    spec = importlib.util.spec_from_file_location(name, path)
    if spec is None or spec.loader is None:
        raise SectionError(f"{path} is not an extension module")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module
