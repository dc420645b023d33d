"""Settings of the test suite."""

from __future__ import annotations

import gc
import signal

import hypothesis

pytest_plugins = ["toy_fixtures"]

# Contract tests of third parties require their installed packages: tests/architecture runs them.
collect_ignore = ["third_party"]

# A background job of a shell ignores SIGINT, and so would the programs that tests start and interrupt.
signal.signal(signal.SIGINT, signal.default_int_handler)

# One profile everywhere: a failure in CI can be reproduced locally with the same examples.
hypothesis.settings.register_profile(
    "evoframe", derandomize=True, deadline=None, max_examples=60, print_blob=True
)
hypothesis.settings.load_profile("evoframe")


def pytest_collection_finish() -> None:
    """Exclude collected tests from garbage collection, which statsmodels triggers in every test."""
    gc.collect()
    gc.freeze()
