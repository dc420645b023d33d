"""Texts rendered from the templates in the folder ``templates``, which has all sentences of conclusions.

An indented line of a template continues the line above it, so each sentence can have lines of its own.
"""

from __future__ import annotations

import functools
import re
from collections.abc import Sequence
from typing import Any

import jinja2

__all__ = ["counted", "listed", "p_value", "written"]


def written(template: str, **values: Any) -> str:
    """Return the text of a template with *values* filled in.

    Args:
        template: File in the folder ``templates``.
        **values: Names in the template -> values, which are inserted unchanged and never parsed as templates.

    Raises:
        jinja2.UndefinedError: The template uses a value that is missing.
    """
    text = _environment().get_template(template).render(values)
    return re.sub(r"\n{3,}", "\n\n", re.sub(r"\n +", " ", text)).strip("\n")


@functools.cache
def _environment() -> jinja2.Environment:
    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("evoframe.analysis.output"),
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        autoescape=False,  # noqa: S701 - plain text; the page escapes all text
    )
    environment.filters |= {"counted": counted, "listed": listed, "p_value": p_value}
    return environment


def counted(count: int, one: str, several: str) -> str:
    """Return a number with its noun: ``1 run``, ``2 runs``."""
    return f"{count} {one if count == 1 else several}"


def listed(items: Sequence[str]) -> str:
    """Return items as an enumeration: ``a, b and c``."""
    return " and ".join(filter(None, [", ".join(items[:-1]), *items[-1:]]))


def p_value(p: float) -> str:
    """Return a p-value with its sign, to follow a ``p``: ``= 0.042``, ``< 0.001``."""
    return "< 0.001" if p < 0.001 else f"= {p:.3f}"
