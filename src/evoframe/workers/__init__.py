"""Worker processes, and the number of cores they may use."""
