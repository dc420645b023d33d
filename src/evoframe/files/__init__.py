"""Files on disk: reading what may come from anyone, atomic writing, locks."""
