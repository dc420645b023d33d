"""A run's directory: what is written while a run goes on, and the run read back from it."""
