"""Output of reports: names, lists and atomic sets of files."""
