"""How many lanes of a vector register pay for compiled runs."""
