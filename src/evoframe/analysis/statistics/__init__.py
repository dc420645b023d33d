"""Statistics of groups of runs: tests, effect sizes, corrections, conclusions."""
