"""``evoframe plugins``."""

from __future__ import annotations

import json
from typing import Any

import click
from rich.table import Table

from evoframe.cli.context import common_options, output, plugins_of
from evoframe.cli.streams import echo
from evoframe.contract import COMPONENTS, POPULATION_COMPONENTS, ROLE_COMPONENTS
from evoframe.registry import Plugins

__all__ = ["plugins"]

_SETTINGS = (
    {kind: f"populations.ROLE.{key}" for key, kind in POPULATION_COMPONENTS.items()}
    | {kind: f"roles.NAME.{key}" for key, kind in ROLE_COMPONENTS.items()}
    | {kind: key for key, kind in COMPONENTS.items()}
)
"""Kind of component -> the key that chooses it in a configuration."""


@click.group()
@common_options
def plugins() -> None:
    """List plugins and the components that they offer."""


@plugins.command(name="list", epilog="\b\nExamples:\n  evoframe plugins list\n  evoframe plugins list --json")
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
@common_options
@click.pass_context
def list_(ctx: click.Context, as_json: bool) -> None:
    """List installed components with the plugins that offer them, and plugins that failed to load."""
    found = plugins_of(ctx)
    if as_json:
        echo(json.dumps(_document(found), indent=2))
        return
    console = output()
    console.print(_table(found))
    for skipped in found.skipped:
        console.print(f"skipped: {skipped.source}: {skipped.cause}", soft_wrap=True)


def _document(found: Plugins) -> dict[str, Any]:
    return {
        "components": [
            {
                "kind": offer.kind,
                "name": offer.name,
                "distribution": offer.source.distribution,
                "version": offer.source.version,
                "entry_point": offer.source.entry_point,
                "class": f"{offer.component.__module__}.{offer.component.__qualname__}",
            }
            for offer in _sorted(found)
        ],
        "skipped": [
            {
                "distribution": skipped.source.distribution,
                "version": skipped.source.version,
                "entry_point": skipped.source.entry_point,
                "cause": skipped.cause,
            }
            for skipped in found.skipped
        ],
    }


def _table(found: Plugins) -> Table:
    table = Table("setting", "name", "description", "distribution", "version", box=None, header_style="bold")
    for offer in _sorted(found):
        [what, *_] = (offer.component.__doc__ or "").strip().splitlines() or [""]
        table.add_row(
            _SETTINGS[offer.kind], offer.name, what, offer.source.distribution, offer.source.version
        )
    return table


def _sorted(found: Plugins) -> list[Any]:
    return sorted(found.offers, key=lambda offer: (offer.kind, offer.name, offer.source))
