"""What is read from histories: spectra, orders, orbits."""
