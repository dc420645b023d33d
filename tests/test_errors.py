"""Errors say what happened, and keep saying it on their way."""

from __future__ import annotations

import pickle

from evoframe.errors import ComponentError


def test_passes_between_processes_with_all_that_it_says() -> None:
    error = ComponentError("simulator", "failed", "a 1 with b 2", keys=(b"key",))
    copied = pickle.loads(pickle.dumps(error))  # noqa: S301 - our own
    assert (str(copied), copied.keys) == ("simulator: failed (a 1 with b 2)", (b"key",))
