"""Load torques, one file each.  A user's own subclasses LoadLaw."""
