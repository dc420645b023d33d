# The extension that libcppn/build_ffi.py makes of libcppn/include/cppn.h.
from typing import Any

ffi: Any
lib: Any
