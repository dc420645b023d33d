"""Configurations: presets, files and overrides, resolved into one checked value."""

from evoframe.config.comments import commented, starter
from evoframe.config.hints import settings_like
from evoframe.config.layers import Layer, Layers, layer_of, layers_in, layers_of, preset_names, read_layers
from evoframe.config.resolve import (
    complete_config,
    load_config,
    named_simulator,
    resolve_component,
    resolve_layers,
    resolve_simulator,
)

__all__ = [
    "Layer",
    "Layers",
    "commented",
    "complete_config",
    "layer_of",
    "layers_in",
    "layers_of",
    "load_config",
    "named_simulator",
    "preset_names",
    "read_layers",
    "resolve_component",
    "resolve_layers",
    "resolve_simulator",
    "settings_like",
    "starter",
]
