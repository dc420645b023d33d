"""Only what the C extensions need; everything else stands in pyproject.toml."""

from setuptools import setup

setup(
    cffi_modules=["extensions.py:libcppn", "extensions.py:libvox"],
    options={"bdist_wheel": {"py_limited_api": "cp311"}},
)
