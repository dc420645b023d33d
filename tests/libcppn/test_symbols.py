"""Symbols that the library exports to the linker and to the loader of the extension."""

from symbols import SymbolTests


class TestSymbols(SymbolTests):
    library = "libcppn"
    prefix = "cppn"
