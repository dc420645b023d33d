"""A study of toy components."""

STUDY = """
extends = "toy.toml"
runs = 3

[run]
seed = 7

[grid]
"collaboration.n" = [1, 2]
simulator = ["toy-product", { name = "toy-varied", gain = 2.0 }]
"""
