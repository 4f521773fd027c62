"""The rotor bench, simulated by a plant of its own."""
