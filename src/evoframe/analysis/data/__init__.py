"""Data frames and other inputs of figures and tables, taken from runs and studies."""
