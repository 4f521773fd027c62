"""Laws of flexspline and mesh stiffness, one file each.  A user's own subclasses StiffnessLaw."""
