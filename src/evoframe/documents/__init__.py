"""Trees of values from TOML and JSON: typed structuring and comparison."""

from evoframe.documents.structuring import Fault, StructureError, option_names, structure, unstructure
from evoframe.documents.trees import Tree, as_read, differences, leaves

__all__ = [
    "Fault",
    "StructureError",
    "Tree",
    "as_read",
    "differences",
    "leaves",
    "option_names",
    "structure",
    "unstructure",
]
