"""Only what the C extension needs; everything else stands in pyproject.toml."""

from setuptools import setup

setup(
    cffi_modules=["libcppn/build_ffi.py:ffibuilder", "libvox/build_ffi.py:ffibuilder"],
    options={"bdist_wheel": {"py_limited_api": "cp311"}},
)
