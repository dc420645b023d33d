"""The plugins of this process: discovery, offered components, observers."""

from evoframe.registry.discovery import discover
from evoframe.registry.hookspecs import hookimpl
from evoframe.registry.observers import Observers
from evoframe.registry.registry import KINDS, Offer, Plugins, kind_of

__all__ = ["KINDS", "Observers", "Offer", "Plugins", "discover", "hookimpl", "kind_of"]
