"""``evoframe completion``."""

from __future__ import annotations

import click
from click.shell_completion import get_completion_class

from evoframe.cli.streams import echo

__all__ = ["completion"]


@click.command(epilog='\b\nExample:\n  eval "$(evoframe completion bash)"')
@click.argument("shell", type=click.Choice(["bash", "zsh", "fish"]))
@click.pass_context
def completion(ctx: click.Context, shell: str) -> None:
    """Print the shell script that completes commands, options and presets."""
    class_ = get_completion_class(shell)
    if class_ is None:
        raise click.UsageError(f"click does not support completion for {shell}")
    echo(class_(ctx.find_root().command, {}, "evoframe", "_EVOFRAME_COMPLETE").source())
