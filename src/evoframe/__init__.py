"""Cooperative coevolution of soft robots: a small core, and plugins for everything else.

This module is the public API: what a plugin author implements (:data:`hookimpl`, the protocols, the values,
the errors) and what a user calls from Python (:func:`run`, :func:`load_run`, :func:`verify`,
:class:`Coevolution`). Each name is loaded at its first use (PEP 562), from the module that ``__init__.pyi``
names.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
