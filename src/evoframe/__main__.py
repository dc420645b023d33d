"""``python -m evoframe``."""

from evoframe.cli import main

main()
