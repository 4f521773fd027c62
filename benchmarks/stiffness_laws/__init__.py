"""The stiffness laws of seed F, Folega et al. 2014: its table, its figures, and each of its claims judged by numbers."""
