"""Effects that a nominal model leaves out, one file each.  A user's own subclasses one of effect.py."""
