"""Bearing laws, one file each: the force between inner ring and housing."""
