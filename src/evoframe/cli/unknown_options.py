"""Hints for options that a command does not have: many are settings, and go to ``--set``."""

from __future__ import annotations

import click

from evoframe.cli.context import plugins_of
from evoframe.config import settings_like

__all__ = ["with_hint"]


def with_hint(error: click.NoSuchOption) -> click.NoSuchOption:
    """Return the error about an unknown option with a hint how to give what was meant."""
    ctx = error.ctx
    if ctx is None:
        return error
    parameters = {parameter.name for parameter in ctx.command.params}
    word = error.option_name.lstrip("-").replace("-", "_")
    hint = ""
    if word in ("preset", "config") and "source" in parameters:
        hint = f"A preset or file is an argument, as in {ctx.command_path} quick"
    elif "overrides" in parameters:
        keys = settings_like(word, plugins_of(ctx))
        others = [key for key in keys if key.rpartition(".")[2] not in parameters]  # click suggests options
        meant = " or ".join(f"--set {key}=VALUE" for key in others)
        hint = f"Did you mean {meant}?" if meant else ""
    return click.NoSuchOption(error.option_name, f"{error.message} {hint}", ctx=ctx) if hint else error
