"""The sections of ``python -m benchmarks``: one question each."""
