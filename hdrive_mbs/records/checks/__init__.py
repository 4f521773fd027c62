"""Checks of a record, one file each: what is found is said, never mended in silence."""
