"""Settings of the C extensions; all other settings are in pyproject.toml."""

from setuptools import setup

setup(
    cffi_modules=["extensions.py:libcppn", "extensions.py:libvox"],
    options={"bdist_wheel": {"py_limited_api": "cp311"}},
)
