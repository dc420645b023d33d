"""Comparison of this version of evoframe with another commit: ``python -m benchmarks --against REV``."""
