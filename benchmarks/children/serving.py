"""Requests and replies of a child process of the benchmarks: one line of JSON each.

The programs in this folder run with other Pythons and other versions of evoframe, so they import nothing else
of the benchmarks.
"""

from __future__ import annotations

import json
import os
import sys
import traceback
from collections.abc import Callable, Mapping
from typing import Any

__all__ = ["serve"]


def serve(handlers: Mapping[str, Callable[..., Any]]) -> None:
    """Call the handler that each request names, until the input ends; reply with its result or its error."""
    with os.fdopen(os.dup(1), "w", encoding="utf-8") as replies:
        os.dup2(2, 1)  # what libraries print is not a reply
        for line in sys.stdin:
            replies.write(json.dumps(_reply(handlers, json.loads(line))) + "\n")
            replies.flush()


def _reply(handlers: Mapping[str, Callable[..., Any]], request: dict[str, Any]) -> dict[str, Any]:
    try:
        return {"result": handlers[request.pop("do")](**request)}
    except Exception as error:  # noqa: BLE001 - the parent reports it
        traceback.print_exc()
        return {"error": f"{type(error).__name__}: {error}"}
