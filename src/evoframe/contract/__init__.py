"""The contract between the core and its plugins: protocols, values, and the value of a configuration."""
