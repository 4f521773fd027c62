"""Analyses: each is a function of a scene that returns one frozen result."""
