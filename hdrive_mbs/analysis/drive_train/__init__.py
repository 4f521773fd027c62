"""Torsional analyses of drive trains."""
