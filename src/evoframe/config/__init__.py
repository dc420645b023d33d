"""Configurations: presets, files and overrides become one checked value."""
