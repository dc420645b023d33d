"""The command line: one file for each command."""

from evoframe.cli.program import cli, main

__all__ = ["cli", "main"]
