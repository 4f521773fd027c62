"""How fast the engine is, at which accuracy, against what else one could use."""
