"""How long differences of a Jacobian should be."""
