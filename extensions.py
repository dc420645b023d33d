"""Builds the extensions of the C libraries; setuptools runs this through ``cffi_modules``.

``EVOFRAME_SANITIZE=1`` builds with the address and undefined-behaviour sanitizers, warnings being errors.
"""

import os
from pathlib import Path

from cffi import FFI

HERE = Path(__file__).parent  # relative to the project's root, as setuptools wants its sources
# No contraction to fused multiply-adds: results would depend on the compiler's choice of them.
FLAGS = (
    *("-std=c11", "-O3", "-ffp-contract=off", "-fno-math-errno", "-fno-trapping-math"),
    "-fvisibility=hidden",  # an extension shows nothing but how it is imported
)
SANITIZE_FLAGS = (
    *("-O1", "-g", "-fno-omit-frame-pointer"),
    *("-fsanitize=address,undefined", "-fno-sanitize-recover=all"),
    *("-Wall", "-Wextra", "-Wconversion", "-Werror"),
)
PREAMBLE = """
#include "{header}"
#ifdef __GNUC__ /* what follows is cffi's, not ours */
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#endif
"""


def declarations(header: Path) -> str:
    """Return a header without its directive lines, which is what cffi reads."""
    lines = header.read_text(encoding="utf-8").splitlines()
    return "\n".join(line for line in lines if not line.startswith("#"))


def extension(folder: str, name: str) -> FFI:
    """Return the builder of the extension of the library in a folder, of which *name*.h is the interface."""
    sanitize = os.environ.get("EVOFRAME_SANITIZE") == "1"
    unix = os.name != "nt"
    library = HERE / folder
    header = library / "include" / f"{name}.h"
    package = library / f"evoframe_{folder}"  # where cffi may have left the C code of an extension
    ffi = FFI()
    ffi.cdef(declarations(header))
    ffi.set_source(
        f"{package.name}._{name}",
        PREAMBLE.replace("{header}", header.name),
        sources=[str(path) for path in sorted(library.rglob("*.c")) if package not in path.parents],
        depends=[str(path) for path in sorted(library.rglob("*.h"))],
        include_dirs=[str(header.parent), str(library)],
        extra_compile_args=[*FLAGS, *(SANITIZE_FLAGS if sanitize else ())] if unix else [],
        extra_link_args=["-fsanitize=address,undefined"] if sanitize else [],
        libraries=["m"] if unix else [],
    )
    return ffi


libcppn = extension("libcppn", "cppn")
libvox = extension("libvox", "vox")
