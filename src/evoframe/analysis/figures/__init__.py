"""Figures for print: studies, bodies, networks, curves."""
