"""Settings of the whole suite."""

from __future__ import annotations

import hypothesis

# One profile everywhere: what fails in CI fails at home, with the same examples.
hypothesis.settings.register_profile(
    "evoframe", derandomize=True, deadline=None, max_examples=60, print_blob=True
)
hypothesis.settings.load_profile("evoframe")
