"""Entry point of ``python -m evoframe``."""

from evoframe.cli import main

if __name__ == "__main__":  # worker processes import this module
    main()
