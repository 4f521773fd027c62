"""How fast and how far joint fits go: with curved steps, with straight ones, and scipy's."""
