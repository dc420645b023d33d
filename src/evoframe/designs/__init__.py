"""Designs that a person names: reading, verifying and exporting them."""
