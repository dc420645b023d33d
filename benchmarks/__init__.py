"""Measurements: what they compare, on what, and the numbers; nothing here is a test."""
