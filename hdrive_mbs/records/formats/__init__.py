"""File formats, one file each: a module with a ``FORMAT`` in this folder takes part without registration."""
