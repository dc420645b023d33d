"""Trees of values from TOML and JSON: structuring and comparing them."""

from evoframe.documents.structuring import Fault, StructureError, structure, unstructure
from evoframe.documents.trees import Tree, as_read, differences, leaves

__all__ = ["Fault", "StructureError", "Tree", "as_read", "differences", "leaves", "structure", "unstructure"]
