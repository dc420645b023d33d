"""Genomes that encode CPPNs: representation, documents, graphs and random streams."""
