"""Harmonic-drive power trains on Exudyn."""
