"""Robustness: the same random controllers for every body."""
