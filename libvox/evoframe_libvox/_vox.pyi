# The extension that libvox/build_ffi.py makes of libvox/include/vox.h.
from typing import Any

ffi: Any
lib: Any
