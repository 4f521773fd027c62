"""Rotors saved by ROSS (ross-rotordynamics) as scenes; ROSS itself is not needed."""
