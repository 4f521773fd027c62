"""The drive bench as a plant: motion, laws, excitation, sensors.  All of it SI."""
