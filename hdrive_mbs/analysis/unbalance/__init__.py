"""Steady response of rotor lines to unbalance and weight."""
