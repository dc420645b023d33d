"""Settings of the whole suite."""

from __future__ import annotations

import gc
import signal

import hypothesis

pytest_plugins = ["toy_fixtures"]

# A job in a shell's background ignores Ctrl-C, and so would the programs that tests start and interrupt.
signal.signal(signal.SIGINT, signal.default_int_handler)

# One profile everywhere: what fails in CI fails at home, with the same examples.
hypothesis.settings.register_profile(
    "evoframe", derandomize=True, deadline=None, max_examples=60, print_blob=True
)
hypothesis.settings.load_profile("evoframe")


def pytest_collection_finish() -> None:
    """Let no collection of garbage look through thousands of tests: statsmodels has one with every test."""
    gc.collect()
    gc.freeze()
