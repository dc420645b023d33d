"""Trees of values from TOML and JSON: structuring and comparing them."""
