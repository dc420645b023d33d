"""Benchmarks: measurements of run times and results, not tests."""
