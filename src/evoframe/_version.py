"""The version of evoframe, defined only here."""

__version__ = "0.1.0"
