"""Benchmarks: each folder holds a command, and beside it the last results that it wrote."""
