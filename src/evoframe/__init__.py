"""Cooperative coevolution of soft robots: a small core, and plugins for everything else.

This module is the public API: what a plugin author implements (:data:`hookimpl`, the protocols, the values,
the errors) and what a user calls from Python (:func:`run`, :func:`load_run`, :func:`verify`,
:class:`Coevolution`). Each name is loaded when it is first asked for (PEP 562); ``__init__.pyi`` beside this
file says where from.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
