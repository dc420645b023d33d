# The extension that extensions.py makes of libvox/include/vox.h.
from typing import Any

ffi: Any
lib: Any
