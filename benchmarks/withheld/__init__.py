"""Withheld cases: two benches simulated by a plant of its own, with sealed labels.  See README.md beside this file."""
