# The extension that extensions.py makes of libcppn/include/cppn.h.
from typing import Any

ffi: Any
lib: Any
