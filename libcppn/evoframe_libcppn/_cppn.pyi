# The extension that extensions.py builds from libcppn/include/cppn.h.
from typing import Any

ffi: Any
lib: Any
