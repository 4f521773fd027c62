"""How often the place of a gap is found without any law, on open cases of both benches."""
