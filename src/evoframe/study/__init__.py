"""A study: a grid of configurations, each run several times, and the rows that come of it."""
