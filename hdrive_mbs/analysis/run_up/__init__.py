"""Runs through critical speeds."""
