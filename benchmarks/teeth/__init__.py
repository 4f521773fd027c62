"""Tooth geometry: speed and accuracy of the sweep and the clearances, and the paper's conclusions judged."""
