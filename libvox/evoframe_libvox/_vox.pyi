# The extension that extensions.py builds from libvox/include/vox.h.
from typing import Any

ffi: Any
lib: Any
