"""The coevolution engine: populations, the loop, and the evaluation of designs. No files, no terminal."""
