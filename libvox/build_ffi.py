"""Builds the extension ``evoframe_libvox._vox``; setuptools runs this through ``cffi_modules``.

``EVOFRAME_SANITIZE=1`` builds with the address and undefined-behaviour sanitizers, warnings being errors.
"""

import os
from pathlib import Path

from cffi import FFI

HERE = Path(__file__).parent  # relative to the project's root, as setuptools wants its sources
SOURCES = tuple(sorted(path.name for path in HERE.glob("*.c")))
# No contraction to fused multiply-adds: results would depend on the compiler's choice of them.
FLAGS = ("-std=c11", "-O3", "-ffp-contract=off", "-fno-math-errno", "-fno-trapping-math")
SANITIZE_FLAGS = (
    *("-O1", "-g", "-fno-omit-frame-pointer"),
    *("-fsanitize=address,undefined", "-fno-sanitize-recover=all"),
    *("-Wall", "-Wextra", "-Wconversion", "-Werror"),
)
PREAMBLE = """
#include "vox.h"
#ifdef __GNUC__ /* what follows is cffi's, not ours */
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#endif
"""


def declarations() -> str:
    """Return the header without its directive lines, which is what cffi reads."""
    lines = (HERE / "include" / "vox.h").read_text(encoding="utf-8").splitlines()
    return "\n".join(line for line in lines if not line.startswith("#"))


def builder() -> FFI:
    """Return the builder of the extension."""
    sanitize = os.environ.get("EVOFRAME_SANITIZE") == "1"
    unix = os.name != "nt"
    ffi = FFI()
    ffi.cdef(declarations())
    ffi.set_source(
        "evoframe_libvox._vox",
        PREAMBLE,
        sources=[str(HERE / name) for name in SOURCES],
        depends=[str(path) for path in (*HERE.glob("*.h"), HERE / "include" / "vox.h")],
        include_dirs=[str(HERE / "include")],
        extra_compile_args=[*FLAGS, *(SANITIZE_FLAGS if sanitize else ())] if unix else [],
        extra_link_args=["-fsanitize=address,undefined"] if sanitize else [],
        libraries=["m"] if unix else [],
    )
    return ffi


ffibuilder = builder()
